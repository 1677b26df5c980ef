"""From an environment to a pyramid of maps, one for each kernel."""

from dataclasses import dataclass, replace
from itertools import groupby

import numpy as np

from ...brdf.oren_nayar import leaning_albedo
from ...conventions import Array
from ...errors import RangeError
from ...filtering.harmonics.analysis import analyse_environment
from ...filtering.harmonics.coefficients import EnvironmentHarmonics
from ...filtering.lookup_error import BilinearLookups, filtered_power
from ...filtering.prefilter import analysis_degree, prefilter, resolved_width
from ...filtering.radial_lobes import cosine_lobe
from ...filtering.zonal import ZonalLobe, ZonalSeries, expand
from ...lobes.bank import KernelBank
from ...lobes.family import KERNELS
from ...lobes.rings import WIDTHS, ring
from ...maps.representation import representation
from ...progress import Progress, Steps
from ...resample import resample
from ...suns import find_suns
from ...ties import TIE
from .pyramid import OCTAHEDRAL, Pyramid

EQUIRECT = representation("equirect")

TEXELS_BY_SHARPNESS = 16.0
"""Width of a kernel's map over the root of its concentration: lookups cost up to 2.3 % of its peak, and 4.7 %
on the folds of the map; .06 % of it in the root mean square over the sphere."""

SMALLEST = 32
"""Least width of the largest maps."""

LEAST_TEXELS = 128
"""Width of the smallest maps, and of those by the normal: with 32, diffuse light is off by .5 %."""

MOST_MISSING = 2.0
"""Width that a map needs over that of the largest; beyond it the mirror's is nearer to a kernel's map."""

TOLERANCE = 1e-5
"""Relative root-mean-square error of filtering; less than that of half floats."""

_TOLERANCE_AT_HORIZON = 1e-3


@dataclass(frozen=True)
class FilterErrors:
    """How far one map is from what it stands for.

    Attributes
    ----------
    bound : ndarray, shape (3,)
        No texel is further than this from the sum over all texels of the environment, and rounding.
    interpolation : float
        Relative root-mean-square error that bilinear lookups are expected to cost.
    """

    bound: Array
    interpolation: float


@dataclass(frozen=True)
class BakedPyramid:
    """A pyramid, and the errors of its maps.

    Attributes
    ----------
    pyramid : Pyramid
    kernels : tuple of FilterErrors
        Of each kernel's map.
    diffuse, rings : tuple of FilterErrors
        Of both diffuse maps, and of each ring's.
    """

    pyramid: Pyramid
    kernels: tuple[FilterErrors, ...]
    diffuse: tuple[FilterErrors, ...]
    rings: tuple[FilterErrors, ...]


def width_of(
    concentration: float, size: int, by_sharpness: float = TEXELS_BY_SHARPNESS, least: int = LEAST_TEXELS
) -> int:
    """Texels along the map of a kernel: a power of 2, or `size`, that of the largest.

    Parameters
    ----------
    concentration : float
    size : int
    by_sharpness : float
        Texels over the root of the concentration, at least.
    least : int
        Width of the smallest maps.
    """
    needed = max(by_sharpness * np.sqrt(concentration), least)
    return min(int(2.0 ** np.ceil(np.log2(needed) - TIE)), size)


def bake_pyramid(radiance: Array, size: int) -> Steps[BakedPyramid]:
    """Filter an environment.

    Parameters
    ----------
    radiance : ndarray, shape (height, 2 * height, 3)
        Latitude-longitude map, not negative.
    size : int
        Width of the largest maps in texels, at least `SMALLEST`; none is wider than the environment.

    Returns
    -------
    BakedPyramid
        With those of `family.KERNELS` that environment and maps resolve.

    Raises
    ------
    RangeError
        The environment resolves no kernel, or no diffuse light.
    """
    yield Progress(0, len(KERNELS) + 1, "analysing the environment")
    size = max(min(size, radiance.shape[1]), SMALLEST)
    diffuse = [expand(lobe, _TOLERANCE_AT_HORIZON) for lobe in (cosine_lobe(), leaning_lobe())]
    series = _resolved(len(radiance), size, diffuse)
    bank = KernelBank(KERNELS.concentrations[: len(series)])
    rings = [expand(ring_lobe(width), _TOLERANCE_AT_HORIZON) for width in WIDTHS]
    harmonics = analyse_environment(radiance, analysis_degree([*series, *diffuse, *rings]))
    (white, leant), diffuse_errors = _filtered(harmonics, diffuse, min(LEAST_TEXELS, size))
    ring_maps, ring_errors = _filtered(harmonics, rings, min(LEAST_TEXELS, size))
    maps: list[Array] = []
    errors: list[FilterErrors] = []
    for width, kernels in groupby(
        zip(bank.concentrations, series, strict=True), lambda pair: width_of(pair[0], size)
    ):
        yield Progress(1 + len(maps), len(KERNELS) + 1, f"filtering {width} texels")
        found, found_errors = _filtered(harmonics, [lobe for _, lobe in kernels], width)
        maps += [sheet[None] for sheet in found]
        errors += found_errors
    mirror = resample(radiance[None], EQUIRECT, OCTAHEDRAL, size, np.float32)
    both = np.stack([white / np.float32(np.pi), leant])
    pyramid = Pyramid(bank, mirror, tuple(maps), both, ring_maps, find_suns(radiance))
    diffuse_errors[0] = replace(diffuse_errors[0], bound=diffuse_errors[0].bound / np.pi)
    return BakedPyramid(pyramid, tuple(errors), tuple(diffuse_errors), tuple(ring_errors))


def _resolved(height: int, size: int, diffuse: list[ZonalSeries]) -> list[ZonalSeries]:
    """The kernels that an environment resolves, and maps of so many texels."""
    least = (1.0 - TIE) * resolved_width(height)
    expanded = [expand(kernel, TOLERANCE) for kernel in KERNELS.lobes()]
    resolved = [
        lobe
        for kappa, lobe in zip(KERNELS.concentrations, expanded, strict=True)
        if lobe.width >= least and TEXELS_BY_SHARPNESS * np.sqrt(kappa) <= MOST_MISSING * size
    ]
    if not resolved or any(lobe.width < least for lobe in diffuse):
        raise RangeError(f"An environment of {height} rows resolves no diffuse light: use a larger one.")
    return resolved


def _filtered(
    harmonics: EnvironmentHarmonics, lobes: list[ZonalSeries], size: int
) -> tuple[Array, list[FilterErrors]]:
    """Maps of some lobes, shape (lobes, size, size, 3), and their errors."""
    found = prefilter(harmonics, lobes, OCTAHEDRAL.texel_directions(size)[0])
    lookups = BilinearLookups(OCTAHEDRAL, size)
    interpolation = [lookups.error(filtered_power(lobe, harmonics)) for lobe in lobes]
    errors = [FilterErrors(*pair) for pair in zip(found.bound, interpolation, strict=True)]
    return found.radiance.astype(np.float32), errors


def leaning_lobe() -> ZonalLobe:
    """max(cos, 0) times `oren_nayar.leaning_albedo`."""

    def profile(lobe_angle: Array) -> Array:
        cosine = np.cos(lobe_angle)
        values: Array = np.where(cosine > 0.0, cosine * leaning_albedo(cosine), 0.0)
        return values

    return ZonalLobe(profile, (0.0, 0.25 * np.pi, 0.5 * np.pi, np.pi))


def ring_lobe(width: float) -> ZonalLobe:
    """`lobes.rings.ring` of a width."""
    knots = [0.5 * np.pi - angle for angle in (8.0 * width, 4.0 * width, 2.0 * width, width, 0.5 * width)]
    within = [angle for angle in knots if angle > 0.0]
    return ZonalLobe(lambda angle: ring(np.cos(angle), width), (0.0, *within, 0.5 * np.pi, np.pi))
