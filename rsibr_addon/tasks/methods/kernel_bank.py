"""An environment to a kernel bank, in a map set: the material is chosen in the preview."""

from math import log2

from ...core.filtering.prefilter import BYTES_BESIDES, bytes_needed
from ...core.lobes.bake import bake_bank
from ...core.options import to_plain
from ...core.progress import Steps
from ...files.kinds.kernel_bank import to_map_set
from ...files.map_set_header import Origin, Recipe
from ...job import BakeJob
from ...settings.kernel_bank import KernelBankSettings
from . import method
from .method import RGB, STORED, Baked, Cost, Method, cost_in_blender


def cost(settings: KernelBankSettings) -> Cost:
    """See `Method`; two paraboloids for each kernel, two kernels more when maps are twice as wide."""
    kernels, texels = int(2 * log2(settings.size)), 2 * settings.size**2
    maps = kernels * texels * RGB
    memory = BYTES_BESIDES + bytes_needed(kernels, texels) + maps
    return cost_in_blender(0.5 + 1e-7 * maps, memory, STORED * maps)


def bake(job: BakeJob[KernelBankSettings], recipe: Recipe) -> Steps[Baked]:
    """Filter an environment with every kernel that the maps resolve: see `Method`.

    Raises
    ------
    RangeError
        The environment resolves no kernel, or the maps are too large for this machine's memory.
    """
    settings = job.settings
    light = yield from method.read_light(job)
    afford = method.afforded_by(job, BYTES_BESIDES)
    baked = yield from bake_bank(light.radiance, settings.layout, settings.size, afford)
    origin = Origin(light, to_plain(settings), method.software_of(job))
    path = yield from method.written(job, recipe, to_map_set(baked, origin))
    kernels, sharpest, size = len(baked.filtered.bank), baked.filtered.sharpest, settings.size
    return Baked(
        path,
        f"{kernels} kernels, the sharpest of concentration {sharpest:g}, {size}x{size} texels",
        {"kernels": kernels, "sharpest": sharpest, "size": size},
    )


METHOD = Method(bake, cost)
