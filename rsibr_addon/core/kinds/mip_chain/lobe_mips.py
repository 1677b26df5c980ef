"""Mips filtered with radially symmetric lobes, wider for smaller mips."""

import math
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np

from ...conventions import Array, texel_centres
from ...errors import RangeError
from ...filtering.harmonics.analysis import analyse_environment
from ...filtering.harmonics.coefficients import EnvironmentHarmonics
from ...filtering.prefilter import analysis_degree, prefilter, resolved_width
from ...filtering.zonal import ZonalLobe, ZonalSeries, expand
from ...maps.representation import representation
from ...resample import lookup, resample
from .chain import check_size

TOLERANCE = 1e-4
"""Relative root-mean-square error of a mip; because of the n.l lobe's kink, less would be expensive."""

EQUIRECT = representation("equirect")
CUBE = representation("cube_map")


@dataclass(frozen=True)
class LobeMip:
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


@dataclass(frozen=True)
class LobeMips:
    """An environment's mips.

    Attributes
    ----------
    harmonics : EnvironmentHarmonics
        Of the environment itself, at least up to the degree that was asked for.
    mips : iterator of LobeMip
        One after another, each made when it is taken, to a relative root-mean-square error of `TOLERANCE`.
    """

    harmonics: EnvironmentHarmonics
    mips: Iterator[LobeMip]


def lobe_mips(
    radiance: Array, size: int, lobes: Sequence[ZonalLobe | None], named: Sequence[str], degree: int = 0
) -> LobeMips:
    """Filter an environment with a lobe for each mip.

    Parameters
    ----------
    radiance : ndarray, shape (height, 2 * height, 3)
        Latitude-longitude map, not negative.
    size : int
        Width of the first mip's faces in texels, a power of 2.
    lobes : sequence of ZonalLobe or None
        None where a mip shows the environment itself.
    named : sequence of str
        What each lobe is called in an error, with the remedy.
    degree : int
        Least degree of the environment's harmonics, which are analysed once for these and for the mips.

    Raises
    ------
    RangeError
        The size is out of range, or a lobe is too narrow: see `core.filtering.zonal.expand`.

    Notes
    -----
    A map whose texels are too large for a lobe is interpolated first, as a mip without a lobe shows it.
    """
    check_size(size, len(lobes))
    expanded = {}
    for mip, lobe in enumerate(lobes):
        if lobe is not None:
            with _naming(mip, named[mip]):
                expanded[mip] = expand(lobe, TOLERANCE)
    series = [*expanded.values()]
    fine = _fine_enough(radiance, series)
    harmonics = analyse_environment(fine, max(degree, analysis_degree(series) if series else 0))
    made = _made(radiance, size, len(lobes), expanded, harmonics, named)
    return LobeMips(harmonics if fine is radiance else analyse_environment(radiance, degree), made)


def _made(
    radiance: Array,
    size: int,
    count: int,
    expanded: Mapping[int, ZonalSeries],
    harmonics: EnvironmentHarmonics,
    named: Sequence[str],
) -> Iterator[LobeMip]:
    for mip in range(count):
        if mip not in expanded:
            yield LobeMip(environment_faces(radiance, size >> mip), 0.0)
            continue
        with _naming(mip, named[mip]):
            filtered = prefilter(harmonics, [expanded[mip]], CUBE.texel_directions(size >> mip))
        yield LobeMip(filtered.radiance[0], float(filtered.bound.max()))


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
def _naming(mip: int, wanted: str) -> Iterator[None]:
    """Name the mip in an error about its lobe."""
    try:
        yield
    except RangeError as error:
        raise RangeError(f"Mip {mip} cannot have {wanted}: {error}") from error


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
