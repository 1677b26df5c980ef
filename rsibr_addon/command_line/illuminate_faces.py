"""Make it from six photographs that look along the axes."""

import argparse
from pathlib import Path
from typing import Any

from ..settings.light import Clamp
from .console import Console
from .illuminate_options import add_environment_output
from .options import add_options, given


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what `run` reads."""
    parser.add_argument(
        "source",
        metavar="NAME.jpg",
        type=Path,
        help="stands for NAME-px.jpg, NAME-nx.jpg, -py, -ny, -pz, -nz: right, left, up, down, ahead and "
        "back, square, 90 degrees wide, upright as one sees them; JPEG, PNG, OpenEXR, Radiance HDR",
    )
    parser.add_argument(
        "--balance",
        action="store_true",
        help="scale each photograph so that they agree along the edges: for a camera that chose its "
        "exposures itself",
    )
    add_options(parser, Clamp)
    add_environment_output(parser)


def run(arguments: argparse.Namespace, console: Console) -> dict[str, Any]:
    """Make the map.

    Returns
    -------
    dict
        "environment", the path of the map; "gains", six times three factors the photographs were scaled by.

    Raises
    ------
    RsibrError
        See `tasks.light.faces`.
    """
    from ..tasks.light.faces import illuminate_from_faces

    target = arguments.output, arguments.balance, arguments.force, given(arguments, Clamp).clamp
    gains = console.steps(illuminate_from_faces(arguments.source, arguments.size, *target))
    console.say(f"{arguments.output}")
    return {"environment": str(arguments.output), "gains": gains.tolist()}
