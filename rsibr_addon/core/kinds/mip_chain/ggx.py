"""Mips filtered with GGX lobes, wider for smaller mips: engines shade glossy surfaces from such mips."""

import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np

from ...conventions import Array, texel_centres
from ...errors import RangeError
from ...filtering.harmonics.analysis import analyse_environment
from ...filtering.prefilter import analysis_degree, prefilter, resolved_width
from ...filtering.radial_lobes import ggx_n_dot_l_lobe
from ...filtering.zonal import ZonalSeries, expand
from ...maps.representation import representation
from ...resample import lookup, resample
from .chain import check_roughness, check_size

TOLERANCE = 1e-4
"""Relative root-mean-square error of a mip; because of the n.l lobe's kink, less would be expensive."""

EQUIRECT = representation("equirect")
CUBE = representation("cube_map")


def linear_roughness(count: int) -> tuple[float, ...]:
    """Roughness in proportion to the mip's number.

    Parameters
    ----------
    count : int
        Number of mips, at least 1.

    Returns
    -------
    tuple of float
        mip / (count - 1); 0 for a single mip.
    """
    return tuple(mip / max(count - 1, 1) for mip in range(count))


def quadratic_roughness(count: int) -> tuple[float, ...]:
    """Roughness r with 2 r - r^2 in proportion to the mip's number: smaller steps where lobes are narrow.

    1 - sqrt(1 - mip / (count - 1)), else as `linear_roughness`. The rule of Filament and its tool cmgen.
    """
    return tuple(1.0 - float(np.sqrt(1.0 - share)) for share in linear_roughness(count))


ROUGHNESS_RULES: dict[str, Callable[[int], tuple[float, ...]]] = {
    "linear": linear_roughness,
    "quadratic": quadratic_roughness,
}
"""Name -> function from a number of mips to their roughnesses, from 0 to 1."""


@dataclass(frozen=True)
class GgxMip:
    """One mip.

    Attributes
    ----------
    faces : ndarray, shape (6, n, n, 3), float64
        Not negative.
    bound : float
        No value is further than this from the sum over all texels of the environment; 0 if the mip was not
        filtered.
    """

    faces: Array
    bound: float


def ggx_mips(radiance: Array, size: int, roughness: Sequence[float]) -> Iterator[GgxMip]:
    """Filter an environment with the GGX lobes that engines filter with: normal = view = mirror direction.

    Parameters
    ----------
    radiance : ndarray, shape (height, 2 * height, 3)
        Latitude-longitude map, not negative.
    size : int
        Width of the first mip's faces in texels, a power of 2.
    roughness : sequence of float
        Roughness of each mip, ascending or equal in [0, 1]. A mip of roughness 0 shows the environment
        itself.

    Yields
    ------
    GgxMip
        One mip after another.

    Raises
    ------
    RangeError
        Size or roughnesses are out of range, or a lobe is too narrow: see `core.filtering.zonal.expand`.

    Notes
    -----
    Radiance times `ggx_n_dot_l_lobe` of alpha = roughness^2, to a relative root-mean-square error of
    `TOLERANCE`: [Karis2013], with the whole sum instead of samples. A map whose texels are too large for a
    lobe is interpolated first, as a mip of roughness 0 shows it.
    """
    check_size(size, len(roughness))
    check_roughness(tuple(roughness), repeated=True)
    lobes = {}
    for mip, r in enumerate(roughness):
        if r > 0.0:
            with _naming(mip, r):
                lobes[mip] = expand(ggx_n_dot_l_lobe(r**2), TOLERANCE)
    degree = analysis_degree([*lobes.values()]) if lobes else 0
    harmonics = analyse_environment(_fine_enough(radiance, [*lobes.values()]), degree)
    for mip, r in enumerate(roughness):
        if mip not in lobes:
            yield GgxMip(environment_faces(radiance, size >> mip), 0.0)
            continue
        with _naming(mip, r):
            filtered = prefilter(harmonics, [lobes[mip]], CUBE.texel_directions(size >> mip))
        yield GgxMip(filtered.radiance[0], float(filtered.bound.max()))


def _fine_enough(radiance: Array, lobes: list[ZonalSeries]) -> Array:
    """The map; or, where it does not resolve a lobe, a finer map interpolated from it."""
    rows = len(radiance)
    narrowest = min((lobe.width for lobe in lobes), default=np.pi)
    if narrowest >= resolved_width(rows):
        return radiance
    finer = 2 * math.ceil(rows * resolved_width(rows) / narrowest)
    interpolated: Array = resample(radiance[None], EQUIRECT, EQUIRECT, 2 * finer)[0]
    return interpolated


@contextmanager
def _naming(mip: int, roughness: float) -> Iterator[None]:
    """Name the mip in an error about its lobe."""
    try:
        yield
    except RangeError as error:
        raise RangeError(
            f"Mip {mip} cannot have roughness {roughness:.3g}, choose a larger one: {error}"
        ) from error


def environment_faces(radiance: Array, size: int) -> Array:
    """An environment as a mirror shows it, on the faces of a cube.

    Parameters
    ----------
    radiance : ndarray, shape (height, 2 * height, 3)
        Latitude-longitude map.
    size : int
        Width of a face in texels.

    Returns
    -------
    ndarray, shape (6, size, size, 3), float64
        Interpolated where a face has at least as many texels as a quarter turn of the map; else the mean over
        each texel.
    """
    if 4 * size < radiance.shape[1]:
        return resample(radiance[None], EQUIRECT, CUBE, size)
    faces = np.empty((6, size, size, radiance.shape[2]))
    uv = texel_centres(size, size)
    for face, texels in enumerate(faces):  # one after the other, to limit the memory of a lookup
        texels[...] = lookup(radiance[None], CUBE.direction_from_uv(uv, np.array(face)), EQUIRECT)
    return faces
