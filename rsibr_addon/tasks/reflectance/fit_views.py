"""Captured views to lobes, in a file: by the views, or by their material where the views tell too little."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from ...core.errors import InputFileError, RangeError, RenderError, SceneError
from ...core.lobes.bake import sharpest_resolved
from ...core.lobes.family_fit import CLOSER_LOBES
from ...core.lobes.fit_in_views import error_in_views
from ...core.progress import Progress, Steps
from ...core.warned import warn
from ...files.atomic import check_target
from ...files.fits import write_fit
from ...settings.fit import FitSettings, Fitting
from ..methods.fit_captures import (
    CapturedResult,
    Captures,
    captured_fit,
    is_reached,
    light_by,
    read_captures,
)
from .brdfs import check_told_brdf, load_brdf
from .model_fits import FitResult, fit_model


def fit_views(settings: FitSettings, output: Path, force: bool = False) -> Steps[CapturedResult | FitResult]:
    """Fit lobes to captured views, or to their material where that comes closer to a goal, and write the fit.

    Parameters
    ----------
    settings : FitSettings
        Of captures.
    output : Path
        NAME.json.
    force : bool
        Whether an existing file is replaced.

    Raises
    ------
    MapSetError
        See `read_captures`.
    RangeError
        See `captured_fit`.
    OutputFileError

    Warns
    -----
    RsibrWarning
        The goal is not reached; the material cannot be had; or see `load_brdf`.
    """
    check_target(output, force, (".json",))
    path = Path(settings.captures or "")
    yield Progress(0, 1, f"reading {path.name}")
    captures = read_captures(path)
    of_captures = yield from captured_fit(captures, settings.captured_views)
    result: CapturedResult | FitResult = of_captures
    if settings.goal is not None and not is_reached(settings.goal, result.fit.left_out):
        result = yield from _closer(of_captures, captures, settings.brdf)
        if not is_reached(settings.goal, result.fit.left_out):
            warn(_missed(settings.goal, result.fit.left_out, captures.noise))
    write_fit(output, result.fit, result.report(), force)
    return result


def _closer(
    found: CapturedResult, captures: Captures, named: str | None
) -> Steps[CapturedResult | FitResult]:
    """A fit to the material itself, if it is closer to the captures than they are to each other."""
    try:
        if named is None:
            check_told_brdf(captures.spec)
        of_material = yield from _fit_to_material(captures, named or captures.spec)
    except (InputFileError, RangeError, RenderError, SceneError) as error:
        warn(f"Lobes cannot be fitted to the material itself, so they are those of the captures: {error}")
        return found
    return of_material if _stated(of_material) < _stated(found) else found


def _stated(found: CapturedResult | FitResult) -> float:
    return np.inf if found.fit.left_out is None else found.fit.left_out


def _fit_to_material(captures: Captures, spec: str) -> Steps[FitResult]:
    brdf = yield from load_brdf(spec)
    # As many lobes for each layer as a fit to captures has for each width
    fitting = Fitting(lobes=CLOSER_LOBES)
    found = yield from fit_model(brdf, fitting, sharpest_resolved(len(captures.radiance)))
    yield Progress(0, 1, "comparing with the captures")
    light = light_by(captures.radiance, found.fit.bank)
    return replace(found, fit=replace(found.fit, left_out=error_in_views(found.fit, light, captures.views)))


def _missed(goal: float, left_out: float | None, noise: float) -> str:
    known = "state no error" if left_out is None else f"have an error of {left_out:.2g} in views left out"
    return (
        f"The lobes {known}, and the goal is {goal:g}: capture more views, or with more samples where the "
        f"captures' noise, {noise:.2g}, counts in that."
    )
