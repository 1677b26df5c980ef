"""Fit radially symmetric lobes to a reflectance model."""

import argparse
from pathlib import Path
from typing import Any

from . import options
from .report import Report


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what `run` reads."""
    parser.add_argument(
        "--brdf",
        metavar="SPEC",
        required=True,
        help="model:key=value,..., as ward:alpha=0.04,ks=0.8 or merl:path=FILE; or blend:FILE.blend:NAME",
    )
    parser.add_argument(
        "--lobes",
        metavar="J",
        type=options.whole,
        default=3,
        help="for each layer of the model, at most (default: %(default)s)",
    )
    parser.add_argument(
        "--slices", metavar="K", type=options.whole, default=16, help="view elevations (default: %(default)s)"
    )
    parser.add_argument(
        "--method",
        choices=["joint", "greedy", "single", "single-2d"],
        default="joint",
        help="all profiles at once, or as Kautz & McCool: several lobes, one, or one that all elevations "
        "share (default: %(default)s)",
    )
    parser.add_argument(
        "--taps",
        metavar="T",
        type=options.whole,
        help="directions in which each lobe's map is looked up (default: as many as pay)",
    )
    parser.add_argument(
        "--error", metavar="E", type=float, help="add lobes only until the error is at most this"
    )
    parser.add_argument(
        "--seek",
        choices=["peaks", "places", "search"],
        default="peaks",
        help="where greedy places lobes: at the highest peak; at the best of peak, mirror direction, normal "
        "and view; or anywhere, by a search from coarse to fine (default: %(default)s)",
    )
    parser.add_argument("--non-negative", action="store_true", help="no kernel with a negative weight")
    parser.add_argument(
        "--plot", metavar="FOLDER", type=Path, help="write polar plots and the error over n.v there, as SVG"
    )
    options.add_output(parser, "FIT.json", "the fit to write")


def run(arguments: argparse.Namespace, report: Report) -> dict[str, Any]:
    """Fit.

    Returns
    -------
    dict
        "fit", the path of the file, and its figures: see `tasks.reflectance.fit_lobes.FitResult`.

    Raises
    ------
    RsibrError
        See `tasks.reflectance.fit_lobes`.
    """
    from ..tasks.reflectance.fit_lobes import FitSettings, fit_lobes

    settings = FitSettings(
        method=arguments.method,
        lobes=arguments.lobes,
        slices=arguments.slices,
        taps=arguments.taps,
        error=arguments.error,
        non_negative=arguments.non_negative,
        seek=arguments.seek,
    )
    result = report.steps(
        fit_lobes(arguments.brdf, settings, arguments.output, arguments.force, arguments.plot)
    )
    figures = result.report()
    report.say(
        f"{arguments.output}: {', '.join(f'{name} {_text(value)}' for name, value in figures.items())}"
    )
    return {"fit": str(arguments.output), **figures}


def _text(value: float | None) -> str:
    return "none" if value is None else f"{value:.3g}"
