"""From a fit and an environment to a stack of maps, as large as its lobes need.

All profiles are sums of the same kernels. So the environment is filtered once with every kernel, and each
map is a sum of these few, weighted with small numbers.
"""

from dataclasses import dataclass

import numpy as np

from ..conventions import Array
from ..errors import RangeError
from ..harmonics.analysis import analyse_environment
from ..harmonics.coefficients import EnvironmentHarmonics
from ..prefilter import analysis_degree, prefilter
from ..progress import Progress, Steps
from ..zonal import TOLERANCE, ZonalSeries, expand
from .fit import Fit
from .stack import LobeStack, stack_representation

SIZES = (16, 32, 64, 128, 256, 512)
"""Widths of maps to choose from."""

ALLOWED_INTERPOLATION = 0.0025
"""Relative root-mean-square error that bilinear lookups may cost where no size is asked for."""


@dataclass(frozen=True)
class BakedStack:
    """A stack, and how near it is to what its fit promises.

    Attributes
    ----------
    stack : LobeStack
    bound : ndarray, shape (3,)
        No texel is further than this from the sum over all texels of the environment, and rounding to
        float32.
    interpolation : float
        What bilinear lookups between texels are expected to cost on a sphere: relative
        root-mean-square error.
    """

    stack: LobeStack
    bound: Array
    interpolation: float


def bake_stack(radiance: Array, fit: Fit, layout: str, size: int | None = None) -> Steps[BakedStack]:
    """Filter an environment with every lobe of a fit.

    Parameters
    ----------
    radiance : ndarray, shape (height, 2 * height, 3)
        Latitude-longitude map, not negative.
    fit : Fit
    layout : str
        One of `stack.LAYOUTS`.
    size : int, optional
        Width of the maps in texels; by default the first of `SIZES` that `ALLOWED_INTERPOLATION` allows,
        or else the last.

    Yields
    ------
    Progress

    Returns
    -------
    BakedStack

    Raises
    ------
    RangeError
        The layout is none, the size is out of range, or a lobe is narrower than the environment resolves.
    """
    if size is not None:
        stack_representation(layout, size)
    used = np.flatnonzero(np.any(fit.weights, axis=(0, 1, 3)))
    yield Progress(0, 2, "analysing the environment")
    kernels = fit.bank.lobes()
    series = [expand(kernels[kernel], TOLERANCE) for kernel in used]
    harmonics = analyse_environment(radiance, analysis_degree(series))
    weights = fit.weights[:, :, used]
    curvature = _curvature(fit, weights, series, harmonics)
    if size is None:
        size = next(
            (n for n in SIZES if _interpolation(curvature, layout, n) <= ALLOWED_INTERPOLATION), SIZES[-1]
        )
    yield Progress(1, 2, f"filtering {fit.weights.shape[0] * fit.weights.shape[1]} maps of {size} texels")
    try:
        filtered = prefilter(harmonics, series, stack_representation(layout, size).texel_directions(size))
    except RangeError as error:
        raise RangeError(f"The fit has lobes that this environment is too coarse for. {error}") from error
    maps = np.einsum("lpkc,k...c->lp...c", weights, filtered.radiance).astype(np.float32)
    bound = np.einsum("lpkc,kc->lpc", np.abs(weights), filtered.bound).max(axis=(0, 1))
    stack = LobeStack(layout, fit.mu, maps, fit.scale, fit.offsets, fit.taps, fit.albedo)
    return BakedStack(stack, bound, _interpolation(curvature, layout, size))


def _curvature(fit: Fit, weights: Array, series: list[ZonalSeries], harmonics: EnvironmentHarmonics) -> float:
    """Root mean square of the maps' Laplacians over that of the radiance, on a sphere seen from afar.

    Degree l of a map has the Laplacian l (l + 1) times itself. A sphere's rings count by mu. What several
    lookups get wrong is taken as independent; radiance is taken as if the lobes of a view had one axis.
    """
    degree = analysis_degree(series)
    gains = np.zeros((len(series), degree + 1))
    for row, lobe in zip(gains, series, strict=True):
        row[: lobe.degree + 1] = lobe.coefficients
    l = np.arange(degree + 1)[:, None]
    light = harmonics.ceilings() ** 2 / (2 * l + 1)
    # Of every lobe and elevation, degree by degree
    amplitude = fit.scale[:, :, None] * np.einsum("lpkc,kd->lpdc", weights, gains)
    lookups = np.sum(fit.taps**2, axis=2)
    bent = np.einsum("s,ls,lsdc,dc->", fit.mu, lookups, amplitude**2, light * (l * (l + 1.0)) ** 2)
    together = np.einsum("ls,lsdc->sdc", fit.taps.sum(axis=2), amplitude)
    return float(np.sqrt(bent / np.einsum("s,sdc,dc->", fit.mu, together**2, light)))


def _interpolation(curvature: float, layout: str, size: int) -> float:
    """Relative root-mean-square error of bilinear lookups.

    Between texels h apart, at a fraction t, a linear lookup errs by h^2 t (1 - t) / 2 times the second
    derivative. Means over t along both axes, for maps that favour no direction, make h^4 times
    (1/40 + 1/144) / 4 of the Laplacian's mean square; and h^2 is a texel's solid angle.
    """
    solid_angle = stack_representation(layout, size).texel_solid_angle(size)
    texel4 = np.sum(solid_angle**3) / np.sum(solid_angle)
    return float(curvature * np.sqrt((1.0 / 40.0 + 1.0 / 144.0) / 4.0 * texel4))
