"""An environment filtered with the kernels of families of lobes, each map as large as its kernel needs."""

from dataclasses import dataclass, replace

import numpy as np

from ...brdf.oren_nayar import leaning_albedo
from ...conventions import Array, ArrayLike
from ...errors import RangeError, ShapeError
from ...filtering.harmonics.analysis import analyse_environment
from ...filtering.harmonics.coefficients import EnvironmentHarmonics
from ...filtering.lookup_error import curvature, interpolation_error
from ...filtering.prefilter import analysis_degree, prefilter, resolved_width
from ...filtering.radial_lobes import cosine_lobe
from ...filtering.zonal import ZonalLobe, ZonalSeries, expand
from ...lobes.bank import KernelBank
from ...lobes.family import KERNELS
from ...maps.representation import representation
from ...progress import Progress, Steps
from ...resample import lookup, resample
from ...ties import TIE

OCTAHEDRAL, EQUIRECT = representation("octahedral"), representation("equirect")

TEXELS_BY_SHARPNESS = 16.0
"""Width of a kernel's map over the root of its concentration: lookups cost up to 1.2 % of its peak."""

SMALLEST, LARGEST = 32, 1024
"""Widths of maps in texels. Broad kernels have larger maps than they need: diffuse light is theirs alone."""

MOST_MISSING = 2.0
"""Width that a map needs over `LARGEST`; beyond it the environment itself is nearer to a kernel's map."""

TOLERANCE = 1e-5
"""Relative root-mean-square error of filtering; less than that of half floats."""

_TOLERANCE_AT_HORIZON = 1e-3


@dataclass(frozen=True, eq=False)
class Pyramid:
    """Octahedral maps of an environment: itself, K kernels, and two diffuse ones.

    Attributes
    ----------
    bank : KernelBank
        K kernels.
    mirror : ndarray, shape (1, n, n, 3)
        The environment itself: what a mirror shows.
    maps : tuple of ndarray, shape (1, n, n, 3) each
        Radiance filtered with each kernel, each of its own width n.
    diffuse : ndarray, shape (2, n, n, 3)
        By direction of the normal: what Lambert's reflection shows of white, and the integral of radiance
        times n.l times `oren_nayar.leaning_albedo`.

    Raises
    ------
    ShapeError
        There are not as many maps as kernels, or a map is no square.
    RangeError
        The kernels are not the first ones of `family.KERNELS`.
    """

    bank: KernelBank
    mirror: Array
    maps: tuple[Array, ...]
    diffuse: Array

    def __post_init__(self) -> None:
        square = all(sheets.shape[1:] == (sheets.shape[1], sheets.shape[1], 3) for sheets in self.all_maps)
        if len(self.maps) != len(self.bank) or not square:
            raise ShapeError("A pyramid has a square map for each of its kernels: bake it again.")
        if self.bank.concentrations != KERNELS.concentrations[: len(self.bank)]:
            raise RangeError("Its kernels are not those that materials are made of: bake it again.")

    @property
    def all_maps(self) -> tuple[Array, ...]:
        """Every map, the sharpest first."""
        return (self.mirror, *self.maps[::-1], self.diffuse)

    @property
    def texels(self) -> int:
        """Number of texels of all maps; as half floats with four channels, each takes 8 bytes of memory."""
        return sum(sheets[..., 0].size for sheets in self.all_maps)

    def kernel(self, concentration: float, direction: ArrayLike) -> Array:
        """The environment filtered with a kernel.

        Parameters
        ----------
        concentration : float
            One of the bank's; of larger ones none is resolved, and the environment itself is shown.
        direction : array_like, shape (..., 3)
            Axes of the kernel.

        Returns
        -------
        ndarray, shape (..., 3)
        """
        if concentration > self.bank.concentrations[-1]:
            return lookup(self.mirror, direction, OCTAHEDRAL)
        number = self.bank.concentrations.index(concentration)
        return lookup(self.maps[number], direction, OCTAHEDRAL)


@dataclass(frozen=True)
class FilterErrors:
    """How far one map is from what it stands for.

    Attributes
    ----------
    bound : ndarray, shape (3,)
        No texel is further than this from the sum over all texels of the environment, and rounding to
        float32.
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
    diffuse : tuple of FilterErrors
        Of both diffuse maps.
    """

    pyramid: Pyramid
    kernels: tuple[FilterErrors, ...]
    diffuse: tuple[FilterErrors, ...]


def width_of(concentration: float) -> int:
    """Texels along the map of a kernel: a power of 2."""
    needed = max(TEXELS_BY_SHARPNESS * np.sqrt(concentration), SMALLEST)
    return min(int(2.0 ** np.ceil(np.log2(needed) - TIE)), LARGEST)


def bake_pyramid(radiance: Array) -> Steps[BakedPyramid]:
    """Filter an environment.

    Parameters
    ----------
    radiance : ndarray, shape (height, 2 * height, 3)
        Latitude-longitude map, not negative.

    Returns
    -------
    BakedPyramid
        With those of `family.KERNELS` that environment and maps resolve, and its own width up to `LARGEST`.

    Raises
    ------
    RangeError
        The environment resolves no kernel.
    """
    yield Progress(0, len(KERNELS) + 1, "analysing the environment")
    series = _resolved(len(radiance))
    cosine, leaning = (expand(lobe, _TOLERANCE_AT_HORIZON) for lobe in (cosine_lobe(), leaning_lobe()))
    harmonics = analyse_environment(radiance, analysis_degree([*series, cosine, leaning]))
    white, white_errors = _filtered(harmonics, cosine, SMALLEST)
    white, white_bound = white / np.float32(np.pi), white_errors.bound / np.pi
    leant, leant_errors = _filtered(harmonics, leaning, SMALLEST)
    maps: list[Array] = []
    errors: list[FilterErrors] = []
    bank = KernelBank(KERNELS.concentrations[: len(series)])
    for lobe, kappa in zip(series, bank.concentrations, strict=True):
        yield Progress(1 + len(maps), len(KERNELS) + 1, f"filtering {width_of(kappa)} texels")
        found, error = _filtered(harmonics, lobe, width_of(kappa))
        maps.append(found)
        errors.append(error)
    size = min(LARGEST, 2 * len(radiance))
    mirror = resample(radiance[None], EQUIRECT, OCTAHEDRAL, size, np.float32)
    pyramid = Pyramid(bank, mirror, tuple(maps), np.concatenate([white, leant]))
    return BakedPyramid(pyramid, tuple(errors), (replace(white_errors, bound=white_bound), leant_errors))


def _resolved(height: int) -> list[ZonalSeries]:
    """The kernels that an environment of so many rows resolves, and maps of `LARGEST` texels."""
    least = (1.0 - TIE) * resolved_width(height)
    expanded = [expand(kernel, TOLERANCE) for kernel in KERNELS.lobes()]
    resolved = [
        lobe
        for kappa, lobe in zip(KERNELS.concentrations, expanded, strict=True)
        if lobe.width >= least and TEXELS_BY_SHARPNESS * np.sqrt(kappa) <= MOST_MISSING * LARGEST
    ]
    if not resolved:
        raise RangeError(f"An environment of {height} rows resolves no kernel: use a larger one.")
    return resolved


def _filtered(harmonics: EnvironmentHarmonics, lobe: ZonalSeries, size: int) -> tuple[Array, FilterErrors]:
    """A map, shape (1, size, size, 3), and its errors."""
    found = prefilter(harmonics, [lobe], OCTAHEDRAL.texel_directions(size))
    interpolation = interpolation_error(curvature(lobe, harmonics), OCTAHEDRAL, size)
    return found.radiance[0].astype(np.float32), FilterErrors(found.bound[0], interpolation)


def leaning_lobe() -> ZonalLobe:
    """max(cos, 0) times `oren_nayar.leaning_albedo`."""

    def profile(lobe_angle: Array) -> Array:
        cosine = np.cos(lobe_angle)
        values: Array = np.where(cosine > 0.0, cosine * leaning_albedo(cosine), 0.0)
        return values

    return ZonalLobe(profile, (0.0, 0.25 * np.pi, 0.5 * np.pi, np.pi))
