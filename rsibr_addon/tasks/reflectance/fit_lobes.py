"""A reflectance model to lobes, in a file."""

import time
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...core.brdf.model import Brdf
from ...core.brdf.spec import spec_from_brdf
from ...core.errors import OutputFileError, RangeError, RsibrWarning
from ...core.lobes.accuracy import FitErrors, fit_errors
from ...core.lobes.bank import SHARPEST
from ...core.lobes.fit import Fit
from ...core.lobes.kautz_mccool import greedy_fit, single_2d_fit, single_fit
from ...core.lobes.layers import layered_fit
from ...core.lobes.seeking import SEEKING
from ...core.lobes.target import elevation_slices
from ...core.progress import Progress, Steps
from ...files.atomic import check_target
from ...files.fits import write_fit
from ...files.outputs import together
from .brdfs import load_brdf
from .fit_plots import check_plots, write_plots

MOST_LOBES, MOST_TAPS = 12, 9


@dataclass(frozen=True)
class FitSettings:
    """How to fit.

    Attributes
    ----------
    method : str
        One of `METHODS`.
    lobes : int
        For each layer of the model, 1 to `MOST_LOBES`.
    slices : int
        View elevations, 1 to 256.
    taps : int or None
        Directions in which each lobe's map is looked up, 1 to `MOST_TAPS`; None for as many as pay, see
        `core.lobes.layers.layered_fit`; of the method joint.
    error : float or None
        Use fewer lobes where E is at most this, above 0 and below 1; of the method joint.
    non_negative : bool
        Whether no kernel may have a negative weight; of the method joint.
    seek : str
        One of `core.lobes.seeking.SEEKING`: where the method greedy places its lobes.
    sharpest : float
        Concentration that no kernel exceeds, one of `core.lobes.bank.octaves`.

    Raises
    ------
    RangeError
        A value is out of its range, or the method has no use for it.
    """

    method: str = "joint"
    lobes: int = 3
    slices: int = 16
    taps: int | None = None
    error: float | None = None
    non_negative: bool = False
    seek: str = "peaks"
    sharpest: float = SHARPEST

    def __post_init__(self) -> None:
        if self.method not in METHODS:
            raise RangeError(f"There is no method {self.method}: choose one of {', '.join(METHODS)}.")
        if not 1 <= self.lobes <= MOST_LOBES:
            raise RangeError(f"{self.lobes} lobes are out of range: choose 1 to {MOST_LOBES}, 3 for most.")
        if self.taps is not None and not 1 <= self.taps <= MOST_TAPS:
            raise RangeError(f"{self.taps} taps are out of range: choose 1 to {MOST_TAPS}.")
        if self.error is not None and not 0.0 < self.error < 1.0:
            raise RangeError(f"An error of {self.error} is out of range: choose one between 0 and 1.")
        if self.seek not in SEEKING:
            raise RangeError(f"Lobes are not sought by {self.seek}: choose one of {', '.join(SEEKING)}.")
        elevation_slices(self.slices)
        joint = (self.taps or 1) > 1 or self.error is not None or self.non_negative
        if joint and self.method != "joint":
            raise RangeError(f"Taps, an error and signs are for the method joint, not {self.method}.")
        if self.seek != "peaks" and self.method != "greedy":
            raise RangeError(f"Where to seek lobes is for the method greedy, not {self.method}.")


@dataclass(frozen=True)
class FitResult:
    """What came out.

    Attributes
    ----------
    fit : Fit
    errors : FitErrors
        At the fitted elevations.
    seconds : float
        Of processor time that the fit took, sampling included and measuring left out.
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
    spec: str, settings: FitSettings, output: Path, force: bool = False, plots: Path | None = None
) -> Steps[FitResult]:
    """Fit a model and write the fit.

    Parameters
    ----------
    spec : str
        The model: see `tasks.reflectance.brdfs.load_brdf`.
    settings : FitSettings
    output : Path
        By custom NAME.json.
    force : bool
        Whether existing files are replaced.
    plots : Path, optional
        A new folder, or one with earlier plots: see `fit_plots.write_plots`.

    Yields
    ------
    Progress

    Returns
    -------
    FitResult

    Raises
    ------
    RangeError
        The text describes no model, or the model is black at an elevation.
    InputFileError, OutputFileError, SceneError, RenderError

    Warns
    -----
    RsibrWarning
        The error asked for takes more lobes; or see `load_brdf`.
    """
    check_target(output, force)
    if plots is not None:
        check_plots(plots, force)
        if output.resolve().is_relative_to(plots.resolve()):
            raise OutputFileError(
                f"{output} would be in {plots}, which holds nothing but plots: write it elsewhere."
            )
    brdf = yield from load_brdf(spec)
    started = time.process_time()
    fit = yield from METHODS[settings.method](brdf, settings)
    seconds = time.process_time() - started
    yield Progress(1, 2, "measuring the fit")
    result = FitResult(fit, fit_errors(fit, brdf), seconds)
    if settings.error is not None and result.errors.error > settings.error:
        warnings.warn(
            f"{settings.lobes} lobes for each layer leave an error of {result.errors.error:.3g}, not "
            f"{settings.error:g}: allow more lobes.",
            RsibrWarning,
            stacklevel=2,
        )
    with together():
        if plots is not None:
            write_plots(plots, result.fit, brdf, result.errors, force)
        write_fit(output, fit, result.report(), force)
    return result


def _joint(brdf: Brdf, settings: FitSettings) -> Steps[Fit]:
    return layered_fit(
        brdf,
        elevation_slices(settings.slices),
        settings.lobes,
        settings.error,
        settings.taps,
        settings.non_negative,
        settings.sharpest,
    )


def _greedy(brdf: Brdf, settings: FitSettings) -> Steps[Fit]:
    yield Progress(0, 1, "fitting minimum profiles")
    mu = elevation_slices(settings.slices)
    return greedy_fit(
        brdf, spec_from_brdf(brdf), mu, settings.lobes, SEEKING[settings.seek], settings.sharpest
    )


def _single(brdf: Brdf, settings: FitSettings) -> Steps[Fit]:
    yield Progress(0, 1, "fitting mean profiles")
    mu = elevation_slices(settings.slices)
    return single_fit(brdf, spec_from_brdf(brdf), mu, settings.sharpest)


def _single_2d(brdf: Brdf, settings: FitSettings) -> Steps[Fit]:
    yield Progress(0, 1, "fitting mean profiles")
    mu = elevation_slices(settings.slices)
    return single_2d_fit(brdf, spec_from_brdf(brdf), mu, settings.sharpest)


METHODS: dict[str, Callable[[Brdf, FitSettings], Steps[Fit]]] = {
    "joint": _joint,
    "greedy": _greedy,
    "single": _single,
    "single-2d": _single_2d,
}
"""Name -> what fits by it."""
