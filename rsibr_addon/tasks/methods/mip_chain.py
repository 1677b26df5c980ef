"""An environment to a mip chain, in a map set."""

from dataclasses import replace

import numpy as np

from ...core.environment import Environment
from ...core.filtering.harmonics.analysis import analyse_environment
from ...core.filtering.prefilter import BYTES_BESIDES, bytes_needed
from ...core.kinds.mip_chain.chain import MipChain
from ...core.kinds.mip_chain.ggx import ggx_mips
from ...core.kinds.mip_chain.mip_lobes import phong_spread, texture_space_spread
from ...core.kinds.mip_chain.phong import phong_mips
from ...core.kinds.mip_chain.probes import Probe
from ...core.kinds.mip_chain.texture_space import box_halved, filtered_mips, tent_halved
from ...core.maps.representation import representation
from ...core.options import to_plain
from ...core.progress import Progress, Steps
from ...core.resample import resample
from ...files.kinds.mip_chain import to_map_set
from ...files.map_set_header import Origin, Recipe
from ...files.memory import check_memory
from ...job import BakeJob
from ...settings.mip_chain import MipChainSettings
from ..light.environments import load_environment
from .method import (
    RGB,
    STORED,
    Baked,
    Cost,
    Method,
    Sources,
    cost_in_blender,
    read_light,
    software_of,
    written,
)

TEXTURE_SPACE = {"box": box_halved, "bordered": tent_halved}
"""Name of a filter that knows texels only -> how it halves a cube map."""

ROUNDING = 2.0**-24
"""Of single precision, half a unit in the last place: the error of mips that are means of texels."""

MIPS_OF_TEXEL = 16
"""Bytes of memory for each texel of the first mip: all mips in single precision."""


def cost(settings: MipChainSettings) -> Cost:
    """See `Method`; all mips together are a third more than the first."""
    chains = 1 + len(settings.rooms)
    maps = chains * 6 * settings.size**2 * RGB * 4 / 3
    filtering = chains * 0.5 if settings.filter in TEXTURE_SPACE else 1.0 + 5e-8 * maps
    memory = BYTES_BESIDES + bytes_needed(1, 6 * settings.size**2) + maps
    return cost_in_blender(filtering, memory, STORED * maps)


def bake(job: BakeJob[MipChainSettings], recipe: Recipe) -> Steps[Baked]:
    """Filter an environment: see `Method`.

    Raises
    ------
    RangeError
        A mip's lobe is narrower than the environment resolves, or the mips are too large for this machine's
        memory.
    InputFileError
        The picture of a probe cannot be used.
    """
    settings = job.settings
    texels = 6 * settings.size**2
    needed = bytes_needed(1, texels) + MIPS_OF_TEXEL * texels * (1 + len(settings.rooms))
    check_memory(needed, job.output, (settings.size, settings.size), BYTES_BESIDES, powers=True)
    light = yield from read_light(job)
    stated = to_plain(settings)
    for name, owner in (("roughness", "ggx"), ("exponents", "phong")):
        if settings.filter != owner:
            del stated[name]
    chain, largest = yield from _chain(light, settings)
    probes = []
    for room in settings.rooms:
        of_room, bound_there = yield from _chain(load_environment(room.light, job.light.clamp), settings)
        probes.append(Probe(room.place, of_room.mips))
        largest = max(largest, bound_there)
    chain = replace(chain, probes=tuple(probes))
    bound = {"relative_to_peak": largest}
    map_set = to_map_set(chain, Origin(light, stated, software_of(job), {"filter": settings.filter}, bound))
    path = yield from written(job, recipe, map_set)
    return Baked(
        path,
        f"{settings.filter} mips from {settings.size}x{settings.size}",
        {
            "filter": settings.filter,
            "size": settings.size,
            "mips": len(chain.mips),
            "probes": len(chain.probes),
        },
    )


def _chain(light: Environment, settings: MipChainSettings) -> Steps[tuple[MipChain, float]]:
    """The chain of a light, and its values' largest error over their mip's largest value."""
    if settings.filter not in TEXTURE_SPACE:
        return (yield from _with_lobes(light, settings))
    yield Progress(1, 2, f"filtering {light.name}")
    return _texture_space(light, settings), ROUNDING


def _with_lobes(light: Environment, settings: MipChainSettings) -> Steps[tuple[MipChain, float]]:
    """See `_chain`."""
    roughness, spread = None, None
    if settings.filter == "ggx":
        roughness = settings.roughnesses
        count = len(roughness)
        filtered = ggx_mips(light.radiance, settings.size, roughness, settings.degree)
    else:
        exponents = settings.phong_exponents
        count = len(exponents)
        spread = tuple(map(phong_spread, exponents))
        filtered = phong_mips(light.radiance, settings.size, exponents, settings.degree)
    mips, bound = [], 0.0
    for number in range(count):
        yield Progress(1 + number, count + 2, f"filtering mip {number}")
        mip = next(filtered.mips)
        mips.append(mip.faces.astype(np.float32))
        # Black has no error
        bound = max(bound, ROUNDING + mip.bound / max(float(mip.faces.max()), 1e-300))
    return MipChain(tuple(mips), filtered.harmonics.real(settings.degree), roughness, spread), bound


def _texture_space(light: Environment, settings: MipChainSettings) -> MipChain:
    faces = resample(
        light.radiance[None], representation("equirect"), representation("cube_map"), settings.size
    )
    halved = TEXTURE_SPACE[settings.filter]
    mips = tuple(mip.astype(np.float32) for mip in filtered_mips(faces, halved))
    spread = texture_space_spread(settings.size, halved)
    harmonics = analyse_environment(light.radiance, settings.degree).real(settings.degree)
    return MipChain(mips, harmonics, spread=spread)


def sources(settings: MipChainSettings) -> Sources:
    """See `Method`."""
    return Sources(lights=tuple(room.light for room in settings.rooms))


METHOD = Method(bake, cost, sources=sources)
