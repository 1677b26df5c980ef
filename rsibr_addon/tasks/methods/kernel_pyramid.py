"""An environment to a kernel pyramid, in a map set: materials are the objects' own."""

from ...core.filtering.prefilter import BYTES_BESIDES, bytes_needed
from ...core.half_floats import half_holds
from ...core.kinds.kernel_pyramid.bake import bake_pyramid, width_of
from ...core.lobes.family import KERNELS
from ...core.options import to_plain
from ...core.progress import Steps
from ...files.kinds.kernel_pyramid import to_map_set
from ...files.map_set_header import Origin, Recipe
from ...job import BakeJob
from ...settings.kernel_pyramid import KernelPyramidSettings
from . import method
from .method import RGB, Baked, Cost, Method, cost_in_blender

_STORED_AS_HALF = 0.3
"""Share of a float of radiance that remains when it is halved and compressed, measured in `forest`."""


def cost(settings: KernelPyramidSettings) -> Cost:
    """See `Method`; the largest maps are the environment itself and the two sharpest kernels."""
    size = settings.size
    maps = RGB * (size**2 + sum(width_of(kappa, size) ** 2 for kappa in KERNELS.concentrations))
    return cost_in_blender(0.5 + 5e-8 * maps, BYTES_BESIDES + _memory(size) + maps, _STORED_AS_HALF * maps)


def _memory(size: int) -> float:
    """Bytes for filtering the largest maps."""
    return bytes_needed(2, size**2)


def bake(job: BakeJob[KernelPyramidSettings], recipe: Recipe) -> Steps[Baked]:
    """Filter an environment with every kernel that it resolves: see `Method`.

    Raises
    ------
    RangeError
        The environment resolves no kernel, or the maps are too large for this machine's memory.
    """
    settings = job.settings
    light = yield from method.read_light(job)
    method.afforded_by(job, BYTES_BESIDES)(_memory(settings.size), settings.size)
    baked = yield from bake_pyramid(light.radiance, settings.size)
    origin = Origin(light, to_plain(settings), method.software_of(job))
    map_set = to_map_set(baked, origin)
    # As graphics cards keep it
    path = yield from method.written(job, recipe, map_set, half_holds([*map_set.maps.values()]))
    size, concentrations = baked.pyramid.mirror.shape[1], baked.pyramid.bank.concentrations
    return Baked(
        path,
        f"{len(concentrations)} kernels, the sharpest of concentration {concentrations[-1]:g}, "
        f"up to {size}x{size} texels",
        {"kernels": len(concentrations), "sharpest": concentrations[-1], "size": size},
    )


METHOD = Method(bake, cost)
