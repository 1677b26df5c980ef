"""Measure how far previews are from what Cycles renders."""

import argparse
from typing import Any

from . import options
from .report import Report

MODES = ["paper", "texel", "fragment"]
WARPS = ["single", "split", "albedo"]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what `run` reads."""
    options.add_map_set(parser)
    parser.add_argument(
        "--views",
        metavar="N",
        type=options.positive,
        default=30,
        help="how many random views to compare (default: %(default)s)",
    )
    options.add_scene(parser, size=128)
    options.add_rendering(parser, samples=64)
    parser.add_argument(
        "--mode", choices=MODES, action="append", help="compare this mode only; may be repeated"
    )
    parser.add_argument(
        "--warp", choices=WARPS, action="append", help="compare this warp only; may be repeated"
    )
    parser.add_argument(
        "--captured-views",
        type=int,
        choices=[12, 42, 162],
        action="append",
        help="draw from so many of the captured views only; may be repeated (default: from all)",
    )
    options.add_output(parser, "FOLDER", "for the page, its pictures and comparison.json")


def run(arguments: argparse.Namespace, report: Report) -> dict[str, Any]:
    """Compare, and write the folder.

    Returns
    -------
    dict
        "page", the path of the HTML page; "comparison", what comparison.json holds.

    Raises
    ------
    RsibrError
        See `tasks.compare`.
    """
    from ..core.shading.radiance_views import Mode, Warping
    from ..tasks.compare import compare
    from ..tasks.comparison import ComparisonSettings, comparison_table

    settings = ComparisonSettings(
        views=arguments.views,
        seed=arguments.seed,
        mesh=arguments.mesh,
        field_of_view=options.radians_or_none(arguments.perspective),
        size=arguments.size,
        samples=arguments.samples,
        modes=tuple(Mode(mode) for mode in arguments.mode or MODES),
        warpings=tuple(Warping(warp) for warp in arguments.warp or WARPS),
        captured_views=tuple(arguments.captured_views or ()),
    )
    comparison = report.steps(compare(arguments.map_set, settings, arguments.output, arguments.force))
    page = arguments.output / "index.html"
    report.say("Relative RMSE against Cycles, over all views:")
    report.say(comparison_table([comparison]))
    report.say(f"{page}")
    return {"page": str(page), "comparison": comparison.to_json()}
