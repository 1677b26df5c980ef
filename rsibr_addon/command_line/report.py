"""The command `rsibr report`."""

import argparse
from pathlib import Path
from typing import Any

from ..settings.report import ReportOptions
from . import options
from .console import Console
from .file_arguments import add_map_set


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what `run` reads."""
    add_map_set(parser)
    parser.add_argument(
        *("-o", "--output"),
        metavar="OUT.html",
        type=Path,
        help="the report, which needs nothing beside it (default: NAME.html beside the map set)",
    )
    parser.add_argument(
        "--maps",
        metavar="FOLDER",
        type=Path,
        help="write each map there too, at its full size, as OpenEXR: a new folder, or one with earlier maps",
    )
    options.add_options(parser, ReportOptions)
    parser.add_argument("--force", action="store_true", help="replace what exists")


def run(arguments: argparse.Namespace, console: Console) -> dict[str, Any]:
    """Write the report.

    Returns
    -------
    dict
        "page", its path; "maps", the folder with the maps, where they are asked for.

    Raises
    ------
    RsibrError
        See `tasks.report.report`.
    """
    from ..files.output_paths import report_beside
    from ..tasks.report.report import map_set_report

    output = arguments.output or report_beside(arguments.map_set)
    brdf = options.given(arguments, ReportOptions).brdf
    page = console.steps(map_set_report(arguments.map_set, output, arguments.force, brdf, arguments.maps))
    written = {"page": str(page)} | ({} if arguments.maps is None else {"maps": str(arguments.maps)})
    for path in written.values():
        console.say(path)
    return written
