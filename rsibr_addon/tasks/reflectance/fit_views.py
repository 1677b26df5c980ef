"""Captured views to lobes, in a file: by the views, or by their material where the views tell too little."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from ...core.errors import InputFileError, RangeError, RenderError, SceneError
from ...core.lobes.bake import sharpest_resolved
from ...core.lobes.fit import Fit
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

LOBES = 6
"""Lobes for each layer of a material that views tell too little of."""


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
    if settings.goal is not None:
        closer = yield from fit_nearer_goal(settings.goal, of_captures.fit, captures, settings.brdf)
        result = closer or result
    write_fit(output, result.fit, result.report(), force)
    return result


def fit_nearer_goal(goal: float, fit: Fit, captures: Captures, named: str | None) -> Steps[FitResult | None]:
    """A fit to the material itself, where that to its captures misses the goal.

    Parameters
    ----------
    goal : float
        Greatest `Fit.left_out`.
    fit : Fit
        To the captures.
    captures : Captures
    named : str or None
        The material, if the user named it: what captures name is not opened.

    Returns
    -------
    FitResult or None
        None where the fit to the captures reaches the goal, or is closer to them.

    Warns
    -----
    RsibrWarning
        The goal is not reached; the material cannot be had; or see `load_brdf`.
    """
    if is_reached(goal, fit.left_out):
        return None
    of_material = yield from _fit_to_material(captures, named)
    closer = of_material if of_material is not None and _stated(of_material.fit) < _stated(fit) else None
    left_out = fit.left_out if closer is None else closer.fit.left_out
    if not is_reached(goal, left_out):
        warn(_missed(goal, left_out, captures.noise))
    return closer


def _stated(fit: Fit) -> float:
    return np.inf if fit.left_out is None else fit.left_out


def _fit_to_material(captures: Captures, named: str | None) -> Steps[FitResult | None]:
    """A fit to the material itself, and its error in the captures; None where the material cannot be had."""
    try:
        if named is None:
            check_told_brdf(captures.spec)
        brdf = yield from load_brdf(named or captures.spec)
        fitting = Fitting(lobes=LOBES)
        found = yield from fit_model(brdf, fitting, sharpest_resolved(len(captures.radiance)))
    except (InputFileError, RangeError, RenderError, SceneError) as error:
        warn(f"Lobes cannot be fitted to the material itself, so they are those of the captures: {error}")
        return None
    yield Progress(0, 1, "comparing with the captures")
    light = light_by(captures.radiance, found.fit.bank)
    return replace(found, fit=replace(found.fit, left_out=error_in_views(found.fit, light, captures.views)))


def _missed(goal: float, left_out: float | None, noise: float) -> str:
    known = "state no error" if left_out is None else f"have an error of {left_out:.2g} in views left out"
    return (
        f"The lobes {known}, and the goal is {goal:g}: capture more views, or with more samples where the "
        f"captures' noise, {noise:.2g}, counts in that."
    )
