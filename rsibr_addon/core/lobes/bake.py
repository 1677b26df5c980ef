"""From an environment to a bank of maps, one for each kernel; and to a fit's stack, summed from one."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np

from ..conventions import Array
from ..errors import RangeError
from ..filtering.harmonics.analysis import analyse_environment
from ..filtering.harmonics.coefficients import EnvironmentHarmonics
from ..filtering.lookup_error import BilinearLookups, filtered_power, light_power
from ..filtering.prefilter import analysis_degree, bytes_needed, prefilter, resolved_width
from ..filtering.zonal import TOLERANCE, ZonalSeries, expand
from ..kinds.kernel_bank.filtered_bank import FilteredBank, bound_from_bank, stack_from_bank
from ..kinds.lobe_stack.stack import LobeStack, stack_representation
from ..progress import Progress, Steps
from ..suns import LOBES_LEAST_SHARE, SHARP_FOR_SUNS, find_suns
from ..ties import TIE
from .bank import SHARP, SHARPEST, KernelBank, octaves
from .fit import Fit

SIZES = (16, 32, 64, 128, 256, 512)
"""Widths of maps to choose from."""

ALLOWED_INTERPOLATION = 0.0025
"""Relative root-mean-square error that bilinear lookups may cost where no size is asked for."""

ALLOWED_OF_A_KERNEL = 0.05
"""The same error allowed for a bank's sharpest kernel, which is only the small tip of a lobe's peak."""

SHARPER = 4.0
"""How much more concentrated than the sharpest kernel that an environment resolves kernels may be. Suns need
no map (`core.suns`), and for other light the map of that sharpest kernel stands in.
"""

_SHARPEST_BY_TEXELS = 0.25

Afford = Callable[[float, int], None]
"""Called before maps are made with their bytes of memory and their width; raises to prevent it."""


def _at_any_cost(needed: float, size: int) -> None:
    pass


@dataclass(frozen=True)
class BakedStack:
    """The parts from which a stack is summed, and the error of lookups in it.

    Attributes
    ----------
    filtered : FilteredBank
        Maps of the kernels that the fit uses; all maps of the stack together can take many times as much
        memory.
    fit : Fit
    sharpest : float
        Concentration of the kernel that stands for sharper ones in the maps.
    interpolation : float
        Relative root-mean-square error that bilinear lookups between texels are expected to cost on a sphere.
    interpolation_suns_apart : float
        The same where suns are taken out of the maps, as we show them; equal where there are none.
    """

    filtered: FilteredBank
    fit: Fit
    sharpest: float
    interpolation: float
    interpolation_suns_apart: float

    @property
    def in_maps(self) -> Fit:
        """The fit as the maps have it."""
        return self.fit.blunted(self.sharpest)

    @property
    def stack(self) -> LobeStack:
        """The stack, with all its maps in memory and suns in them."""
        return stack_from_bank(self.filtered, self.in_maps)[0]

    @property
    def bound(self) -> Array:
        """No texel is further from the sum over all texels, and rounding to float32; shape (3,)."""
        return bound_from_bank(self.filtered, self.in_maps)


@dataclass(frozen=True)
class BakedBank:
    """A bank, and the error of lookups in it.

    Attributes
    ----------
    filtered : FilteredBank
    interpolation : tuple of float
        Relative root-mean-square error that bilinear lookups in each kernel's map are expected to cost.
    """

    filtered: FilteredBank
    interpolation: tuple[float, ...]


@cache
def sharpest_resolved(height: int) -> float:
    """Concentration of the sharpest kernel that an environment resolves.

    Parameters
    ----------
    height : int
        Height of the environment in rows.

    Returns
    -------
    float
        One of `bank.octaves`.

    Raises
    ------
    RangeError
        It resolves no kernel.
    """
    bank, least = octaves(SHARPEST), (1.0 - TIE) * resolved_width(height)
    resolved = [
        kappa for kappa, lobe in zip(bank.concentrations, _expanded(bank), strict=True) if lobe.width >= least
    ]
    if not resolved:
        raise RangeError(f"An environment of {height} rows resolves no kernel: use a larger one.")
    return resolved[-1]


def bake_bank(radiance: Array, layout: str, size: int, afford: Afford = _at_any_cost) -> Steps[BakedBank]:
    """Filter an environment with every kernel that environment and maps resolve.

    Parameters
    ----------
    radiance : ndarray, shape (height, 2 * height, 3)
        Latitude-longitude map, not negative.
    layout : str
        One of `stack.LAYOUTS`.
    size : int
        Width of the maps in texels.
    afford : callable
        See `Afford`.

    Returns
    -------
    BakedBank
        Bank of the kernels of `bank.octaves` that keep `ALLOWED_OF_A_KERNEL`.

    Raises
    ------
    RangeError
        There is no such layout, the size is out of range, or no kernel is resolved.
    """
    sheets = stack_representation(layout, size)
    yield Progress(0, 2, "analysing the environment")
    bank = octaves(min(_SHARPEST_BY_TEXELS * size**2, sharpest_resolved(len(radiance)), SHARP))
    series = _expanded(bank)
    harmonics = analyse_environment(radiance, analysis_degree(series))
    lookups = BilinearLookups(sheets, size)
    costs = [lookups.error(filtered_power(lobe, harmonics)) for lobe in series]
    count = max(sum(cost <= ALLOWED_OF_A_KERNEL for cost in costs), 1)
    afford(_bytes(count, layout, size), size)
    yield Progress(1, 2, f"filtering {count} maps of {size} texels")
    bank = KernelBank(bank.concentrations[:count])
    return BakedBank(_filtered(harmonics, bank, series[:count], layout, size), tuple(costs[:count]))


def bake_stack(
    radiance: Array, fit: Fit, layout: str, size: int | None = None, afford: Afford = _at_any_cost
) -> Steps[BakedStack]:
    """Filter an environment with every lobe of a fit.

    Parameters
    ----------
    size : int, optional
        Width of the maps in texels; by default the first of `SIZES` that `ALLOWED_INTERPOLATION` allows,
        or else the last.
    radiance, layout, afford
        See `bake_bank`.

    Raises
    ------
    RangeError
        There is no such layout, the size is out of range, or a kernel is more than `SHARPER` times as
        concentrated as the environment resolves.
    """
    if size is not None:
        stack_representation(layout, size)
    sharpest = _standing_in(fit.bank.kappa[fit.used], len(radiance))
    in_maps = fit.blunted(sharpest)

    def cost(width: int, looked_up: Array) -> float:
        return BilinearLookups(stack_representation(layout, width), width).error(looked_up, power)

    yield Progress(0, 2, "analysing the environment")
    bank = KernelBank(tuple(in_maps.bank.concentrations[kernel] for kernel in in_maps.used))
    series = _expanded(bank)
    harmonics = analyse_environment(radiance, analysis_degree(series))
    whole = light_power(harmonics, analysis_degree(series))
    apart = _power_without_suns(radiance, whole)
    in_file, power = _power(in_maps, series, whole, whole[None])
    is_sharp = bank.kappa[:, None, None] >= SHARP_FOR_SUNS
    shown, _ = _power(in_maps, series, whole, np.where(is_sharp, apart, whole))
    if size is None:
        # Other programs look the maps up with suns in them
        size = next((n for n in SIZES if cost(n, in_file) <= ALLOWED_INTERPOLATION), SIZES[-1])
    afford(_bytes(len(bank), layout, size), size)
    yield Progress(1, 2, f"filtering {fit.weights.shape[0] * fit.weights.shape[1]} maps of {size} texels")
    try:
        filtered = _filtered(harmonics, bank, series, layout, size)
    except RangeError as error:
        raise RangeError(f"This environment is too coarse for some lobes of the fit. {error}") from error
    return BakedStack(filtered, fit, sharpest, cost(size, in_file), cost(size, shown))


def filter_environment(radiance: Array, bank: KernelBank, layout: str, size: int) -> FilteredBank:
    """Filter an environment with the kernels of a bank.

    Parameters
    ----------
    bank : KernelBank
    radiance, layout, size
        See `bake_bank`.

    Returns
    -------
    FilteredBank
        Of all kernels; those that the environment does not resolve have the map of the sharpest that it does.

    Raises
    ------
    RangeError
        There is no such layout, the size is out of range, or a kernel is more than `SHARPER` times as
        concentrated as the environment resolves.
    """
    in_maps = np.minimum(bank.kappa, _standing_in(bank.kappa, len(radiance)))
    distinct, number = np.unique(in_maps, return_inverse=True)
    series = _expanded(KernelBank(tuple(distinct.tolist())))
    harmonics = analyse_environment(radiance, analysis_degree(series))
    filtered = prefilter(harmonics, series, stack_representation(layout, size).texel_directions(size))
    return FilteredBank(layout, bank, filtered.radiance[number], filtered.bound[number])


def _standing_in(kappa: Array, height: int) -> float:
    """Concentration of the kernel that stands for sharper ones in maps of an environment."""
    resolved = sharpest_resolved(height)
    # Filtering refuses a kernel for which none may stand
    return resolved if kappa.max(initial=0.0) <= SHARPER * resolved else float(kappa.max())


def _bytes(kernels: int, layout: str, size: int) -> float:
    """Memory for a filtered bank, also in single precision as it is written."""
    texels = int(np.prod(stack_representation(layout, size).shape(size)))
    return bytes_needed(kernels, texels) + 12.0 * kernels * texels


def _expanded(bank: KernelBank) -> list[ZonalSeries]:
    return [expand(kernel, TOLERANCE) for kernel in bank.lobes()]


def _filtered(
    harmonics: EnvironmentHarmonics, bank: KernelBank, series: Sequence[ZonalSeries], layout: str, size: int
) -> FilteredBank:
    filtered = prefilter(harmonics, series, stack_representation(layout, size).texel_directions(size))
    return FilteredBank(layout, bank, filtered.radiance, filtered.bound)


def _power_without_suns(radiance: Array, whole: Array) -> Array:
    """Power by degree of an environment without its suns, given that of all of it; shape (D, 3)."""
    suns = find_suns(radiance, LOBES_LEAST_SHARE)
    if not len(suns):
        return whole
    degree = len(whole) - 1
    return light_power(analyse_environment(np.minimum(radiance, suns.ceiling), degree), degree)


def _power(fit: Fit, series: list[ZonalSeries], light: Array, in_maps: Array) -> tuple[Array, float]:
    """Power by degree of all that is looked up on a sphere seen from afar, and power of its radiance.

    A sphere's rings count by mu. Errors of several lookups are taken as independent, and radiance as if all
    lobes of a view had one axis.

    series: of the K kernels that the fit uses. light: power by degree, shape (D, 3). in_maps: power of what
    the kernels' maps hold of it, shape (K, D, 3) or (1, D, 3).
    """
    gains = np.zeros((len(series), len(light), 1))
    for row, lobe in zip(gains, series, strict=True):
        row[: lobe.degree + 1, 0] = lobe.coefficients
    weights = fit.weights[:, :, fit.used]
    # Of every lobe and elevation, degree by degree
    held, whole = (
        fit.scale[:, :, None] * np.einsum("lpkc,kdc->lpdc", weights, gains * np.sqrt(power))
        for power in (in_maps, light)
    )
    looked_up = np.einsum("s,ls,lsdc->dc", fit.mu, np.sum(fit.taps**2, axis=2), held**2)
    together = np.einsum("ls,lsdc->sdc", fit.taps.sum(axis=2), whole)
    return looked_up, float(np.einsum("s,sdc->", fit.mu, together**2))
