"""A reflectance model, or captured views, to lobes, in a file."""

from collections.abc import Sequence
from pathlib import Path

from ...core.brdf.model import Brdf
from ...core.brdf.spec import spec_from_brdf
from ...core.errors import OutputFileError, RangeError
from ...core.lobes.fit import Fit
from ...core.progress import Steps
from ...core.warned import warn
from ...files.atomic import check_target
from ...files.fits import read_fit, write_fit
from ...files.outputs import together
from ...settings.fit import FitSettings
from ..methods.fit_captures import CapturedResult
from .brdfs import load_brdf
from .fit_plots import check_plots, write_plots
from .fit_views import fit_views
from .model_fits import FitResult, fit_model


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
        Or see `fit_views`.

    Warns
    -----
    RsibrWarning
        The error asked for takes more lobes; or see `load_brdf` and `fit_views`.
    """
    if beside and plots is None:
        raise RangeError("Fits beside are for the plot of the errors: give --plot, or leave them out.")
    names = [output.stem, *(path.stem for path in beside)]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise RangeError(f"Fits are plotted under their files' names, but two are {twice}: rename one.")
    if settings.captures is not None:
        if plots is not None:
            raise RangeError("There is no model to plot beside a fit to captures: plot a fit to a model.")
        return (yield from fit_views(settings, output, force))
    check_target(output, force, (".json",))
    if plots is not None:
        check_plots(plots, force)
        if output.resolve().is_relative_to(plots.resolve()):
            raise OutputFileError(
                f"{output} would be in {plots}, which holds nothing but plots: write it elsewhere."
            )
    brdf = yield from load_brdf(settings.brdf or "")
    others = {path.stem: _fit_of(path, brdf) for path in beside}
    result = yield from fit_model(brdf, settings)
    if settings.error is not None and result.errors.error > settings.error:
        warn(
            f"{settings.lobes} lobes for each layer leave an error of {result.errors.error:.3g}, not "
            f"{settings.error:g}: allow more lobes."
        )
    with together():
        if plots is not None:
            write_plots(plots, {output.stem: result.fit, **others}, brdf, result.errors, force)
        write_fit(output, result.fit, result.report(), force)
    return result


def _fit_of(path: Path, brdf: Brdf) -> Fit:
    """A fit of the model."""
    fit, spec = read_fit(path), spec_from_brdf(brdf)
    if fit.brdf != spec:
        raise RangeError(f"{path} is a fit of {fit.brdf}, not of {spec}: plot it beside fits of its model.")
    return fit
