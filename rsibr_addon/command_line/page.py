"""Show all that a map set holds on one HTML page."""

import argparse
from pathlib import Path
from typing import Any

from . import options
from .report import Report


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what `run` reads."""
    options.add_map_set(parser)
    parser.add_argument(
        *("-o", "--output"),
        metavar="OUT.html",
        type=Path,
        help="the page, which needs nothing beside it (default: NAME.html beside the map set)",
    )
    parser.add_argument(
        "--brdf",
        metavar="SPEC",
        help="the model to plot beside a lobe stack's lobes, where it is in a file, as rsibr bake takes it "
        "(default: what the map set names)",
    )
    parser.add_argument("--force", action="store_true", help="replace what exists")


def run(arguments: argparse.Namespace, report: Report) -> dict[str, Any]:
    """Write the page.

    Returns
    -------
    dict
        "page", its path.

    Raises
    ------
    RsibrError
        See `tasks.report.report`.
    """
    from ..files.output_paths import report_beside
    from ..tasks.report.report import map_set_report

    output = arguments.output or report_beside(arguments.map_set)
    page = report.steps(map_set_report(arguments.map_set, output, arguments.force, arguments.brdf))
    report.say(f"{page}")
    return {"page": str(page)}
