"""Make it from a painted picture, whose whites become lamps."""

import argparse
from pathlib import Path
from typing import Any

from .console import Console
from .convert import LAYOUTS
from .illuminate_options import add_environment_output
from .options import colour


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what `run` reads."""
    parser.add_argument(
        "source", metavar="PICTURE", type=Path, help="JPEG, PNG and the like, of 8 or 16 bits"
    )
    parser.add_argument(
        "--from",
        metavar="LAYOUT",
        dest="source_layout",
        choices=LAYOUTS,
        default="equirect",
        help=f"how it is laid out: {', '.join(LAYOUTS)} (default: %(default)s)",
    )
    parser.add_argument(
        "--white",
        metavar="RADIANCE|R,G,B",
        type=colour,
        required=True,
        help="what white becomes, 1 or more; the darker a colour the less it is lifted",
    )
    parser.add_argument(
        "--knee",
        metavar="X",
        type=float,
        default=0.7,
        help="linear luminance up to which nothing is lifted, 0 to 1 (default: %(default)g)",
    )
    add_environment_output(parser)


def run(arguments: argparse.Namespace, console: Console) -> dict[str, Any]:
    """Make the map.

    Returns
    -------
    dict
        "environment", the path of the map.

    Raises
    ------
    RsibrError
        See `tasks.light.painted`.
    """
    from ..tasks.light.painted import PaintedSettings, illuminate_from_painting

    settings = PaintedSettings(arguments.source_layout, arguments.size, arguments.white, arguments.knee)
    output = console.steps(
        illuminate_from_painting(arguments.source, settings, arguments.output, arguments.force)
    )
    console.say(f"{output}")
    return {"environment": str(output)}
