"""An environment to a mip chain, in a map set."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ...core.conventions import Array
from ...core.environment import Environment
from ...core.errors import RangeError
from ...core.filtering.harmonics.analysis import analyse_environment
from ...core.filtering.prefilter import BYTES_BESIDES, bytes_needed
from ...core.kinds.mip_chain.chain import MipChain, check_roughness, check_size
from ...core.kinds.mip_chain.ggx import ROUGHNESS_RULES, ggx_mips
from ...core.kinds.mip_chain.texture_space import box_halved, filtered_mips, tent_halved
from ...core.maps.representation import representation
from ...core.progress import Progress, Steps
from ...core.resample import resample
from ...files.atomic import check_target
from ...files.kinds.mip_chain import to_map_set
from ...files.map_set import write_map_set
from ...files.memory import check_memory
from ...host.version import software
from ..light.environments import load_environment

TEXTURE_SPACE = {"box": box_halved, "bordered": tent_halved}
"""Name of a filter that knows texels only -> how it halves a cube map."""

MIPS_OF_TEXEL = 16
"""Bytes of memory for each texel of the first mip: all mips in single precision."""

FILTERS = (*TEXTURE_SPACE, "ggx")


@dataclass(frozen=True)
class MipSettings:
    """How to filter.

    Attributes
    ----------
    filter : str
        One of `FILTERS`.
    size : int
        Width of the first mip's faces in texels, a power of 2.
    roughness : str or tuple of float
        Of the filter ggx: a name of `core.kinds.mip_chain.ggx.ROUGHNESS_RULES`, for mips down to a single
        texel; or the roughness of every mip, ascending in [0, 1].

    Raises
    ------
    RangeError
        A value is out of range, or a filter that knows no roughness is given one.
    """

    filter: str = "ggx"
    size: int = 256
    roughness: str | tuple[float, ...] = "linear"

    def __post_init__(self) -> None:
        check_size(self.size, 1)
        if self.filter not in FILTERS:
            raise RangeError(f"There is no filter {self.filter}: choose one of {', '.join(FILTERS)}.")
        if isinstance(self.roughness, str):
            if self.roughness not in ROUGHNESS_RULES:
                rules = ", ".join(ROUGHNESS_RULES)
                raise RangeError(f"There is no roughness rule {self.roughness}: choose {rules}, or numbers.")
        elif self.filter != "ggx":
            raise RangeError(f"The filter {self.filter} knows no roughness: leave it out, or choose ggx.")
        else:
            check_size(self.size, len(self.roughness))
            check_roughness(self.roughness)

    @property
    def roughnesses(self) -> tuple[float, ...]:
        """Of every mip of the filter ggx."""
        if isinstance(self.roughness, str):
            return ROUGHNESS_RULES[self.roughness](self.size.bit_length())
        return self.roughness


def bake_mips(
    environment: str | None,
    settings: MipSettings,
    output: Path,
    force: bool = False,
    clamp: float | None = None,
) -> Steps[Path]:
    """Filter an environment.

    Parameters
    ----------
    environment : str or None
        A latitude-longitude file, a name of one of Blender's own, or None for the open file's world:
        see `load_environment`.
    settings : MipSettings
    output : Path
        By custom NAME.rsibr.exr.
    force : bool
        Whether an existing file is replaced.
    clamp : float, optional
        See `core.environment.usable_radiance`.

    Yields
    ------
    Progress

    Returns
    -------
    Path
        `output`.

    Raises
    ------
    InputFileError, OutputFileError, SceneError, RenderError
    RangeError
        A mip's lobe is narrower than the environment resolves, or the mips are too large for this machine's
        memory.

    Warns
    -----
    RsibrWarning
        See `core.environment.usable_radiance`.
    """
    check_target(output, force)
    texels = 6 * settings.size**2
    check_memory(
        bytes_needed(1, texels) + MIPS_OF_TEXEL * texels,
        str(output),
        (settings.size, settings.size),
        BYTES_BESIDES,
        powers=True,
    )
    total = settings.size.bit_length() + 2
    yield Progress(0, total, "reading the environment")
    light = load_environment(environment, clamp)
    stated: dict[str, Any] = {"filter": settings.filter, "size": settings.size}
    bound = None
    if settings.filter == "ggx":
        stated["roughness"] = settings.roughness
        chain, largest = yield from _ggx(light, settings, total)
        bound = {"relative_to_peak": largest}
    else:
        yield Progress(1, total, "filtering")
        chain = _texture_space(light, settings)
    yield Progress(total - 1, total, f"writing {output.name}")
    map_set = to_map_set(chain, light, {"filter": settings.filter}, bound, stated, software())
    write_map_set(output, map_set, force)
    return output


def _ggx(light: Environment, settings: MipSettings, total: int) -> Steps[tuple[MipChain, float]]:
    """The chain, and its values' largest error over their mip's largest value."""
    roughness = settings.roughnesses
    mips, bound = [], 0.0
    filtering = ggx_mips(light.radiance, settings.size, roughness)
    for number in range(len(roughness)):
        yield Progress(1 + number, total, f"filtering mip {number}")
        mip = next(filtering)
        mips.append(mip.faces.astype(np.float32))
        # Single precision rounds by half a unit in the last place; black has no error.
        bound = max(bound, 2.0**-24 + mip.bound / max(float(mip.faces.max()), 1e-300))
    return MipChain(tuple(mips), _harmonics(light), roughness), bound


def _texture_space(light: Environment, settings: MipSettings) -> MipChain:
    faces = resample(
        light.radiance[None], representation("equirect"), representation("cube_map"), settings.size
    )
    mips = filtered_mips(faces, TEXTURE_SPACE[settings.filter])
    return MipChain(tuple(mip.astype(np.float32) for mip in mips), _harmonics(light))


def _harmonics(light: Environment) -> Array:
    return analyse_environment(light.radiance, 2).real(2)
