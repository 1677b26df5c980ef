"""An environment to a bank of kernels, in a map set: materials are chosen while one looks."""

from math import log2

from ...core.filtering.prefilter import BYTES_BESIDES, bytes_needed
from ...core.lobes.bake import bake_bank
from ...core.options import to_plain
from ...core.progress import Steps
from ...files.kinds.kernel_bank import from_map_set, to_map_set
from ...host.version import software
from ...job import BakeJob
from ...settings.kernel_bank import KernelBankSettings
from .kind import Kind
from .live_materials import LiveMaterials
from .method import (
    BLENDER_MEMORY,
    BLENDER_SECONDS,
    ENVIRONMENT_TEXELS,
    RGB,
    STORED,
    Baked,
    Cost,
    Method,
    afforded_by,
    read_light,
    written,
)


def cost(settings: KernelBankSettings) -> Cost:
    """See `Method`; two paraboloids for each kernel, two kernels more when maps are twice as wide."""
    kernels, texels = int(2 * log2(settings.size)), 2 * settings.size**2
    maps = kernels * texels * RGB
    return Cost(
        BLENDER_SECONDS + 0.5 + 1e-7 * maps,
        BLENDER_MEMORY + BYTES_BESIDES + bytes_needed(kernels, texels) + maps,
        STORED * (maps + ENVIRONMENT_TEXELS * RGB),
    )


def bake(job: BakeJob[KernelBankSettings]) -> Steps[Baked]:
    """Filter an environment with every kernel that the maps resolve.

    Raises
    ------
    InputFileError, OutputFileError, SceneError, RenderError
    RangeError
        The environment resolves no kernel, or the maps are too large for this machine's memory.

    Warns
    -----
    RsibrWarning
        See `load_environment`.
    """
    settings = job.settings
    light = yield from read_light(job)
    afford = afforded_by(job, BYTES_BESIDES)
    baked = yield from bake_bank(light.radiance, settings.layout, settings.size, afford)
    path = yield from written(job, to_map_set(baked, light, to_plain(settings), software()))
    kernels, sharpest, size = len(baked.filtered.bank), baked.filtered.sharpest, settings.size
    return Baked(
        path,
        f"{kernels} kernels, the sharpest of concentration {sharpest:g}, {size}x{size} texels",
        {"kernels": kernels, "sharpest": sharpest},
    )


KIND = Kind(
    from_map_set, LiveMaterials, Method(bake, cost), newest=LiveMaterials.newest, menu="RSIBR_MT_live_models"
)
