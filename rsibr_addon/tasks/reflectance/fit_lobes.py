"""A reflectance model to lobes, in a file."""

import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...core.brdf.model import Brdf
from ...core.brdf.spec import spec_from_brdf
from ...core.errors import OutputFileError, RangeError
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
from ...core.warned import warn
from ...files.atomic import check_target
from ...files.fits import read_fit, write_fit
from ...files.outputs import together
from ...settings.fit import FitSettings, Fitting
from ..methods.fit_captures import CapturedResult, fit_to_captures
from .brdfs import load_brdf
from .fit_plots import check_plots, write_plots


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
        }


def fit_lobes(
    settings: FitSettings,
    output: Path,
    force: bool = False,
    plots: Path | None = None,
    beside: Sequence[Path] = (),
) -> Steps[FitResult | CapturedResult]:
    """Fit a model, or captured views, and write the fit.

    Parameters
    ----------
    settings : FitSettings
    output : Path
        NAME.json.
    force : bool
        Whether existing files are replaced.
    plots : Path, optional
        A new folder, or one with earlier plots: see `fit_plots.write_plots`.
    beside : sequence of Path
        Other fits of the model, whose errors are plotted beside.

    Raises
    ------
    RangeError
        The text describes no model, or the model is black at an elevation; captures are to be plotted; or
        fits are to be plotted beside that are of another model, of one name, or without `plots`.
    InputFileError, OutputFileError, SceneError, RenderError
        Or see `fit_to_captures`.

    Warns
    -----
    RsibrWarning
        The error asked for takes more lobes; or see `load_brdf`.
    """
    if beside and plots is None:
        raise RangeError("Fits beside are for the plot of the errors: give --plot, or leave them out.")
    names = [output.stem, *(path.stem for path in beside)]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise RangeError(f"Fits are plotted under their files' names, but two are {twice}: rename one.")
    if settings.brdf is None:
        if plots is not None:
            raise RangeError("There is no model to plot beside a fit to captures: plot a fit to a model.")
        captures = Path(settings.captures or "")
        return (yield from fit_to_captures(captures, output, settings.captured_views, force))
    check_target(output, force, (".json",))
    if plots is not None:
        check_plots(plots, force)
        if output.resolve().is_relative_to(plots.resolve()):
            raise OutputFileError(
                f"{output} would be in {plots}, which holds nothing but plots: write it elsewhere."
            )
    brdf = yield from load_brdf(settings.brdf)
    others = {path.stem: _fit_of(path, brdf) for path in beside}
    started = time.process_time()
    fit = yield from fitted(brdf, settings)
    seconds = time.process_time() - started
    yield Progress(1, 2, "measuring the fit")
    result = FitResult(fit, fit_errors(fit, brdf), seconds)
    if settings.error is not None and result.errors.error > settings.error:
        warn(
            f"{settings.lobes} lobes for each layer leave an error of {result.errors.error:.3g}, not "
            f"{settings.error:g}: allow more lobes."
        )
    with together():
        if plots is not None:
            write_plots(plots, {output.stem: result.fit, **others}, brdf, result.errors, force)
        write_fit(output, fit, result.report(), force)
    return result


def _fit_of(path: Path, brdf: Brdf) -> Fit:
    """A fit of the model."""
    fit, spec = read_fit(path), spec_from_brdf(brdf)
    if fit.brdf != spec:
        raise RangeError(f"{path} is a fit of {fit.brdf}, not of {spec}: plot it beside fits of its model.")
    return fit


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
