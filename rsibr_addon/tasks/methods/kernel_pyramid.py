"""An environment to a kernel pyramid, in a map set: materials are the objects' own."""

from ...core.filtering.prefilter import BYTES_BESIDES, bytes_needed
from ...core.kinds.kernel_pyramid.pyramid import LARGEST, bake_pyramid, width_of
from ...core.lobes.family import KERNELS
from ...core.options import to_plain
from ...core.progress import Steps
from ...files.kinds.kernel_pyramid import to_map_set
from ...files.map_set_header import Origin
from ...job import BakeJob
from ...settings.kernel_pyramid import KernelPyramidSettings
from . import method
from .method import RGB, STORED, Baked, Cost, Method, cost_in_blender


def cost(settings: KernelPyramidSettings) -> Cost:
    """See `Method`."""
    maps = RGB * sum(width**2 for width in (LARGEST, *map(width_of, KERNELS.concentrations)))
    memory = BYTES_BESIDES + bytes_needed(1, LARGEST**2) + maps
    return cost_in_blender(5.0, memory, STORED * maps)


def bake(job: BakeJob[KernelPyramidSettings]) -> Steps[Baked]:
    """Filter an environment with every kernel that it resolves: see `Method`.

    Raises
    ------
    RangeError
        The environment resolves no kernel, or the maps are too large for this machine's memory.
    """
    light = yield from method.read_light(job)
    method.afforded_by(job, BYTES_BESIDES)(cost(job.settings).memory - BYTES_BESIDES, LARGEST)
    baked = yield from bake_pyramid(light.radiance)
    origin = Origin(light, to_plain(job.settings), method.software_of(job))
    path = yield from method.written(job, to_map_set(baked, origin))
    size, concentrations = baked.pyramid.mirror.shape[1], baked.pyramid.bank.concentrations
    return Baked(
        path,
        f"{len(concentrations)} kernels, the sharpest of concentration {concentrations[-1]:g}, "
        f"up to {size}x{size} texels",
        {"kernels": len(concentrations), "sharpest": concentrations[-1], "size": size},
    )


METHOD = Method(bake, cost)
