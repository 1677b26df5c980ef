"""Joint fits of whole models, layer by layer: each layer has one kind of lobe, which is easier to fit."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ..brdf.model import Brdf
from ..brdf.spec import spec_from_brdf
from ..conventions import Array
from ..progress import Progress, Steps
from .accuracy import fit_errors
from .bank import SHARPEST
from .fit import Fit, joined
from .joint import JointFitter
from .smoothing import PRICES, TOLERATED
from .target import TargetSlice, target_slices

NEGLIGIBLE = 0.1
"""Share of the whole error below which a layer gets no more lobes."""

CLOSE, TAPS = 0.1, 3
"""E above which lobes get more lookups, and their number: they cost no maps, only time to draw."""

PAYS = 0.8
"""Greatest share of E, at elevations that were not fitted, that taps may leave to be kept: taps that follow a
measurement's noise leave more, and flicker from one elevation to the next."""


@dataclass
class _Layer:
    """One layer, with as many lobes as it has so far.

    Attributes
    ----------
    share : ndarray, shape (S,)
        Share of the layer's power in that of the whole model.
    """

    brdf: Brdf
    fitter: JointFitter
    share: Array
    fit: Fit | None = None
    error: float = np.inf

    def track(self, taps: int) -> None:
        """Fit the present lobes."""
        self.fit, errors = self.fitter.fit(taps)
        self.error = float(np.sqrt(np.mean(errors**2 * self.share)))

    def look_up_more(self, fit: Fit) -> None:
        """Fit `TAPS` taps, and take them instead of a fit with one where they pay."""
        several, _ = self.fitter.fit(TAPS)
        one_error, error = (fit_errors(each, self.brdf, _between(fit.mu)).error for each in (fit, several))
        if error <= PAYS * one_error:
            self.fit = several

    def smooth(self, fit: Fit) -> None:
        """Take the smoothest fit that is nearly as good halfway between elevations as the best."""
        fits = [fit, *(self.fitter.smooth(fit, price) for price in PRICES)]
        errors = [fit_errors(each, self.brdf, _between(fit.mu)).error for each in fits]
        self.fit = [
            each for each, error in zip(fits, errors, strict=True) if error <= TOLERATED * min(errors)
        ][-1]


def layered_fit(
    brdf: Brdf,
    mu: Sequence[float] | Array,
    lobes: int,
    error: float | None = None,
    taps: int | None = None,
    non_negative: bool = False,
    sharpest: float = SHARPEST,
) -> Steps[Fit]:
    """Fit the sum of a model's layers.

    Parameters
    ----------
    brdf : Brdf
    mu : sequence of float
        Cosines of the view elevations, ascending, in (0, 1].
    lobes : int
        Most lobes of each layer; where there are several layers, those that are `NEGLIGIBLE` get fewer.
    error : float, optional
        E of the whole at which no more lobes are added, each to the layer with the largest error.
    taps : int, optional
        Directions in which each lobe's map is looked up. By default 1; where E of the whole exceeds `CLOSE`,
        `TAPS` in layers that are not `NEGLIGIBLE` and where it pays.
    non_negative : bool
        Whether no kernel may have a negative weight.
    sharpest : float
        Concentration that no kernel exceeds, one of `bank.octaves`.

    Raises
    ------
    RangeError
        An elevation lies outside (0, 1]; a layer is black at one of them, or not finite.
    """
    spec = spec_from_brdf(brdf)
    yield Progress(0, 1, "sampling the reflectance")
    layers = list(_layers(brdf, mu, lambda slices: JointFitter(slices, spec, non_negative, sharpest)))
    if error is None and len(layers) == 1:
        yield from _grown_at_once(layers[0], lobes, taps or 1)
    else:
        yield from _grown_in_turn(layers, lobes, error, taps or 1)
    together = _together(layers)
    if taps is None and together > CLOSE:
        for layer in layers:
            if layer.fit is not None and layer.error >= NEGLIGIBLE * together:
                yield Progress(0, 1, f"looking up lobes in {TAPS} directions")
                layer.look_up_more(layer.fit)
    for layer in layers:
        if layer.fit is not None and layer.brdf.is_noisy and not non_negative:
            yield Progress(0, 1, "smoothing over elevations")
            layer.smooth(layer.fit)
    return joined([layer.fit for layer in layers if layer.fit is not None], spec)


def _between(mu: Array) -> Array:
    """Some elevations halfway between the fitted ones; one or two elevations themselves."""
    halfway: Array = 0.5 * (mu[1:] + mu[:-1])
    return halfway[1::4] if len(halfway) > 1 else mu


def _together(layers: Sequence[_Layer]) -> float:
    """E of the whole."""
    return float(np.sqrt(sum(layer.error**2 for layer in layers)))


def _grown_at_once(layer: _Layer, lobes: int, taps: int) -> Steps[None]:
    for done in range(lobes):
        yield Progress(done, lobes + 1, f"adding lobe {done + 1}")
        layer.fitter.grow()
    yield Progress(lobes, lobes + 1, "tracking lobes over elevations")
    layer.track(taps)


def _grown_in_turn(layers: Sequence[_Layer], lobes: int, error: float | None, taps: int) -> Steps[None]:
    """Give each next lobe to the layer with the largest error."""
    total = len(layers) * lobes
    for done in range(total):
        together = _together(layers)
        if error is not None and together <= error:
            break
        growing = [layer for layer in layers if layer.fitter.lobes < lobes]
        worst = max(growing, key=lambda layer: layer.error)
        if worst.fit is not None and worst.error < NEGLIGIBLE * together:
            break
        yield Progress(done, total, f"fitting lobe {worst.fitter.lobes + 1} of {type(worst.brdf).__name__}")
        worst.fitter.grow()
        worst.track(taps)


def _layers(
    brdf: Brdf, mu: Sequence[float] | Array, fitter: Callable[[tuple[TargetSlice, ...]], JointFitter]
) -> Iterator[_Layer]:
    whole = target_slices(brdf, mu)
    for layer in brdf.layers:
        # Most models are their own only layer; sampling them again would cost as much as fitting
        slices = whole if layer is brdf else target_slices(layer, mu)
        share = np.array([part.power / all_.power for part, all_ in zip(slices, whole, strict=True)])
        yield _Layer(layer, fitter(slices), share)
