"""An environment filtered with radially symmetric lobes: fast and with an error bound, or by brute force.

Filtering is a product in spherical harmonics, and exact: the result of "analyse, multiply, synthesise" *is*
the sum over all texels of radiance times solid angle times lobe, except for the degrees that are left out and
the interpolation. The errors of both are bounded (docs/prefiltering.md).

>>> series = [expand(lobe) for lobe in lobes]
>>> harmonics = analyse_environment(environment.radiance, analysis_degree(series))
>>> stack = prefilter(harmonics, series, directions)
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..conventions import Array, ArrayLike, texel_centres
from ..errors import RangeError, ShapeError
from ..maps import equirect
from ..ties import TIE
from .harmonics.coefficients import EnvironmentHarmonics
from .harmonics.synthesis import INTERPOLATION, synthesise
from .zonal import ZonalLobe, ZonalSeries

BYTES_BESIDES = 2e8
"""Bytes of memory for harmonics and their grid, and for maps while they are written."""

_CUT_SHARE = 0.5
_TEXELS_ACROSS = 3.0
_BRUTE_BYTES = 2**25


@dataclass(frozen=True)
class Prefiltered:
    """A stack of maps: an environment filtered with one lobe after another.

    Attributes
    ----------
    radiance : ndarray, shape (slices, ..., channels), float64
        One slice for each lobe, in the given directions; not negative, except where the lobe is.
    bound : ndarray, shape (slices, channels)
        No value is further than this from the sum over all texels.
    degrees : tuple of int
        Degree after which each lobe was cut.
    """

    radiance: Array
    bound: Array
    degrees: tuple[int, ...]


def analysis_degree(series: Sequence[ZonalSeries]) -> int:
    """Degree to which an environment must be analysed for some lobes, at least one."""
    return max(lobe.degree for lobe in series)


def resolved_width(height: int) -> float:
    """Width [rad] of the narrowest lobe that a map of so many rows resolves: three texels."""
    return _TEXELS_ACROSS * np.pi / height


def bytes_needed(slices: int, points: int) -> float:
    """Memory for filtering three channels.

    Parameters
    ----------
    slices, points : int
        Numbers of lobes and of directions.

    Returns
    -------
    float
        Bytes for the maps, those of a few lobes once more, and the directions with their angles; without
        `BYTES_BESIDES`, which does not depend on the points.
    """
    return 8.0 * points * (3 * slices + 3 * min(slices, 4) + 8)


def prefilter(
    harmonics: EnvironmentHarmonics, series: Sequence[ZonalSeries], directions: ArrayLike
) -> Prefiltered:
    """Filter an environment with radially symmetric lobes.

    Parameters
    ----------
    harmonics : EnvironmentHarmonics
        Harmonics of an environment without negative radiance, up to `analysis_degree` of the lobes or
        further.
    series : sequence of ZonalSeries
        One lobe for each slice, expanded for the tolerance of its slice.
    directions : array_like, shape (..., 3)
        Where to evaluate: lobe axes, of any positive length.

    Returns
    -------
    Prefiltered
        The relative root-mean-square error over the sphere, of each slice and each channel, is within the
        lobe's tolerance.

    Raises
    ------
    RangeError
        A lobe is narrower than the map resolves or needs a degree that was not analysed; a direction is
        not finite.
    ShapeError
        Directions do not have three components.
    """
    theta, phi, shape = _polar_angles(directions)
    for number, lobe in enumerate(series, 1):
        _check_resolved(harmonics, lobe, number)
    ceilings = harmonics.ceilings()
    degrees = [_cut(lobe, ceilings) for lobe in series]
    channels = len(harmonics.flux)
    # Channel by channel, in the order in which maps are summed
    by_channel = np.empty((channels, len(series), len(theta)))
    bound = np.empty((len(series), channels))
    for i, (lobe, degree) in enumerate(zip(series, degrees, strict=True)):
        by_channel[:, i] = synthesise(harmonics, lobe.coefficients[: degree + 1], theta, phi)
        bound[i] = _bound(lobe, degree, ceilings, harmonics.flux)
    radiance = np.moveaxis(by_channel, 0, -1)
    for lobe, values in zip(series, radiance, strict=True):
        if not lobe.signed:
            # Values that the cut makes negative are nearer to the truth at 0.
            np.maximum(values, 0.0, out=values)
    return Prefiltered(radiance.reshape(len(series), *shape, channels), bound, tuple(degrees))


def prefilter_exact(radiance: Array, lobes: Sequence[ZonalLobe], directions: ArrayLike) -> Array:
    """The sum over all texels of radiance times solid angle times lobe, by brute force.

    Parameters
    ----------
    radiance : ndarray, shape (height, width, channels)
        Latitude-longitude map.
    lobes : sequence of ZonalLobe
        One for each slice.
    directions : array_like, shape (..., 3)
        Lobe axes.

    Returns
    -------
    ndarray, shape (slices, ..., channels), float64

    Raises
    ------
    RangeError
        A direction is not finite.
    ShapeError
        Directions do not have three components.

    Notes
    -----
    Equation 1: the oracle of `prefilter`, with harmonics of texels as points.
    """
    theta, phi, shape = _polar_angles(directions)
    axes = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1)
    height, width, channels = radiance.shape
    texels = equirect.direction_from_uv(texel_centres(width, height)).reshape(-1, 3)
    light = (radiance * equirect.texel_solid_angle(width, height)[..., None]).reshape(-1, channels)
    filtered = np.empty((len(lobes), len(axes), channels))
    step = max(1, _BRUTE_BYTES // (24 * len(texels)))
    for start in range(0, len(axes), step):
        part = slice(start, start + step)
        # Half the chord is the sine of half the angle; the cosine would lose the digits of small angles.
        chord = np.linalg.norm(axes[part, None] - texels, axis=-1)
        angle = 2.0 * np.arcsin(np.minimum(0.5 * chord, 1.0))
        for lobe, values in zip(lobes, filtered, strict=True):
            values[part] = lobe.profile(angle) @ light
    return filtered.reshape(len(lobes), *shape, channels)


def _polar_angles(directions: ArrayLike) -> tuple[Array, Array, tuple[int, ...]]:
    """Colatitude, longitude in [0, 2 pi), and the shape of the directions without their last axis."""
    directions = np.asarray(directions, dtype=np.float64)
    if directions.ndim == 0 or directions.shape[-1] != 3:
        raise ShapeError(f"Directions have three components, but these have shape {directions.shape}.")
    if not np.all(np.isfinite(directions)):
        raise RangeError("A direction is NaN or infinite: give unit vectors.")
    x, y, z = directions.reshape(-1, 3).T
    return np.arctan2(np.hypot(x, y), z), np.arctan2(y, x) % (2.0 * np.pi), directions.shape[:-1]


def _check_resolved(harmonics: EnvironmentHarmonics, lobe: ZonalSeries, number: int) -> None:
    least = resolved_width(harmonics.height)
    if lobe.width < (1.0 - TIE) * least:
        raise RangeError(
            f"Lobe {number} is {np.degrees(lobe.width):.3g} degrees wide, and a map of {harmonics.height} "
            f"rows resolves {np.degrees(least):.3g}: widen the lobe to that, or use a larger map."
        )
    if lobe.degree > harmonics.degree:
        raise RangeError(
            f"Lobe {number} needs harmonics up to degree {lobe.degree}, but the environment was analysed "
            f"to {harmonics.degree}: analyse it further."
        )


def _power(gains: Array, ceilings: Array) -> Array:
    """Mean square of every filtered degree over the sphere, shape (..., degrees, channels)."""
    l = np.arange(gains.shape[-1])[:, None]
    power: Array = (gains[..., None] * ceilings[: len(l)]) ** 2 / (2 * l + 1)
    return power


def _cut(lobe: ZonalSeries, ceilings: Array) -> int:
    """The degree after which a cut keeps the tolerance in every channel: equation 9."""
    power = _power(lobe.coefficients, ceilings)
    tail = np.cumsum(power[::-1], axis=0)[::-1]
    kept = np.any(tail > (_CUT_SHARE * lobe.tolerance) ** 2 * tail[0], axis=1)
    return max(int(np.count_nonzero(kept)) - 1, 1)


def _bound(lobe: ZonalSeries, degree: int, ceilings: Array, flux: Array) -> Array:
    """Largest error of a slice, shape (channels,): equations 6, 7 and 10."""
    largest = ceilings[: lobe.degree + 1] * np.abs(lobe.coefficients[:, None])
    beyond_cut, beyond_known = lobe.truncation_errors(degree, lobe.degree)
    left_out = np.minimum(largest[degree + 1 :].sum(axis=0) + beyond_known * flux, beyond_cut * flux)
    bound: Array = left_out + INTERPOLATION * largest.sum(axis=0)
    return bound
