"""A reflectance model to lobes, and how close they are."""

import time
from dataclasses import dataclass
from typing import Any

from ...core.brdf.model import Brdf
from ...core.brdf.spec import spec_from_brdf
from ...core.lobes.accuracy import FitErrors, fit_errors
from ...core.lobes.bank import SHARPEST
from ...core.lobes.fit import Fit
from ...core.lobes.kautz_mccool import (
    greedy_fit,
    single_2d_fit,
    single_fit,
    with_outer_cosine,
    without_cosine,
)
from ...core.lobes.layers import layered_fit
from ...core.lobes.seeking import SEEKING
from ...core.lobes.target import elevation_slices
from ...core.progress import Progress, Steps
from ...settings.fit import Fitting


@dataclass(frozen=True)
class FitResult:
    """A fit, and its figures.

    Attributes
    ----------
    fit : Fit
    errors : FitErrors
        At the fitted elevations.
    seconds : float
        Processor time of the fit, with sampling and without measuring.
    """

    fit: Fit
    errors: FitErrors
    seconds: float

    def report(self) -> dict[str, Any]:
        """The figures, as JSON values."""
        return {
            "lobes": len(self.fit.weights),
            "slices": len(self.fit.mu),
            "taps": self.fit.taps.shape[2],
            "E": self.errors.error,
            "E_grazing": self.errors.grazing_error,
            "albedo_error": self.errors.albedo_error,
            "amplification": float(self.errors.amplification.max()),
            "seconds": self.seconds,
            **({} if self.fit.left_out is None else {"source": "material", "left_out": self.fit.left_out}),
        }


def fit_model(brdf: Brdf, settings: Fitting, sharpest: float = SHARPEST) -> Steps[FitResult]:
    """Fit lobes to a model and measure them: see `fitted`."""
    started = time.process_time()
    fit = yield from fitted(brdf, settings, sharpest)
    seconds = time.process_time() - started
    yield Progress(1, 2, "measuring the fit")
    return FitResult(fit, fit_errors(fit, brdf), seconds)


def fitted(brdf: Brdf, settings: Fitting, sharpest: float = SHARPEST) -> Steps[Fit]:
    """Fit lobes to a model, none sharper than `sharpest`, one of `core.lobes.bank.octaves`.

    Raises
    ------
    RangeError
        The model is black at an elevation.
    """
    mu = elevation_slices(settings.slices)
    if settings.method == "joint":
        return (
            yield from layered_fit(
                brdf, mu, settings.lobes, settings.error, settings.taps, settings.non_negative, sharpest
            )
        )
    yield Progress(0, 1, "fitting profiles")
    spec, outside = spec_from_brdf(brdf), settings.cosine == "outside"
    target = without_cosine(brdf) if outside else brdf
    if settings.method == "greedy":
        fit = greedy_fit(target, spec, mu, settings.lobes, SEEKING[settings.seek], sharpest)
    else:
        single = single_fit if settings.method == "single" else single_2d_fit
        fit = single(target, spec, mu, sharpest)
    return with_outer_cosine(fit) if outside else fit
