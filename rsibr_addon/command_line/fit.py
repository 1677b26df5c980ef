"""The command `rsibr fit`."""

import argparse
from pathlib import Path
from typing import Any

from ..settings.fit import FitSettings
from . import options
from .console import Console
from .file_arguments import add_output

EXPLAINED = {
    "left_out": "error of captured views that the lobes were not fitted to, noise included",
    "untested": "share of new views that may be worse, as no captured view left out tells of them",
    "E": "error: root mean square of fit - model over that of the model, over all elevations",
    "E_grazing": "the same over elevations near grazing, n.v below 0.1",
    "albedo_error": "greatest relative error of the reflected energy",
    "amplification": "how much the errors of single maps may grow in their sum, at most",
}
"""Figure of a fit -> what it says."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what `run` reads."""
    options.add_options(parser, FitSettings)
    parser.add_argument(
        "--plot", metavar="FOLDER", type=Path, help="write polar plots and the error over n.v there, as SVG"
    )
    parser.add_argument(
        "--beside",
        metavar="FIT.json",
        type=Path,
        nargs="+",
        default=[],
        help="other fits of the model, whose errors are plotted beside, in error.svg",
    )
    add_output(parser, "FIT.json", "the fit to write")


def run(arguments: argparse.Namespace, console: Console) -> dict[str, Any]:
    """Fit.

    Returns
    -------
    dict
        "fit", the path of the file, and its figures: see `tasks.reflectance.model_fits.FitResult` and
        `tasks.methods.fit_captures.CapturedResult`.

    Raises
    ------
    RsibrError
        See `tasks.reflectance.fit_lobes`.
    """
    from ..tasks.reflectance.fit_lobes import fit_lobes

    settings = options.given(arguments, FitSettings)
    result = console.steps(
        fit_lobes(settings, arguments.output, arguments.force, arguments.plot, arguments.beside)
    )
    figures = result.report()
    plain = ", ".join(f"{name} {_text(value)}" for name, value in figures.items() if name not in EXPLAINED)
    console.say(f"{arguments.output}: {plain}")
    for name, explanation in EXPLAINED.items():
        if name not in figures:
            continue
        console.say(f"  {name:<14} {_text(figures[name]):<9} {explanation}")
    return {"fit": str(arguments.output), **figures}


def _text(value: float | str | list[float] | None) -> str:
    if isinstance(value, str):
        return value
    if isinstance(value, list):
        return " and ".join(map(_text, value)) or "none"
    return "none" if value is None else f"{value:.3g}"
