"""Make it from photographs of a mirrored ball, from one side or from two."""

import argparse
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

from .console import Console
from .illuminate_options import add_bracket, add_environment_output, bracket_settings, exposure_times
from .options import degrees


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what `run` reads."""
    add_bracket(parser, "the photograph, or several at different exposures")
    parser.add_argument(
        "--circle",
        metavar="X,Y,R",
        type=_circle,
        help="the ball's outline in pixels from the top left corner of the photograph as it is stored, "
        "not turned by its Exif (default: found)",
    )
    distance = parser.add_mutually_exclusive_group()
    distance.add_argument(
        "--distance", metavar="D", type=float, help="of the camera in radii of the ball (default: far away)"
    )
    distance.add_argument(
        "--fov",
        metavar="DEG",
        type=degrees,
        help="angle of view of the photograph's longer side, not cropped: tells the distance",
    )
    parser.add_argument(
        "--elevation",
        metavar="DEG",
        type=float,
        default=0.0,
        help="how far the camera looked down on the ball (default: %(default)g)",
    )
    parser.add_argument(
        "--camera",
        metavar="DEG",
        type=float,
        default=15.0,
        help="how far from its middle the camera and who held it show in the ball, as an angle of direction; "
        "there the other side counts (default: %(default)g)",
    )
    second = parser.add_argument_group("a second side, which shows what the first cannot")
    second.add_argument("--second", metavar="PHOTO", nargs="+", type=Path, help="as PHOTO")
    second.add_argument(
        "--turn",
        metavar="DEG",
        type=float,
        default=90.0,
        help="how far the camera went around the ball, counterclockwise as seen from above (default: "
        "%(default)g)",
    )
    second.add_argument("--second-circle", metavar="X,Y,R", type=_circle, help="as --circle")
    second.add_argument("--second-times", metavar="T,T,...", type=exposure_times, help="as --times")
    add_environment_output(parser)


def run(arguments: argparse.Namespace, console: Console) -> dict[str, Any]:
    """Unwrap.

    Returns
    -------
    dict
        "environment", the path of the map; "circles", of each photograph its path and x, y and radius of
        the outline from its top left corner; "gains", what each side was multiplied by.

    Raises
    ------
    RsibrError
        See `tasks.light.ball`.
    """
    from ..tasks.light.ball import BallSettings, SideSettings, illuminate_from_ball

    bracket = bracket_settings(arguments)
    sides = [SideSettings(bracket, arguments.circle)]
    if arguments.second is not None:
        second = replace(bracket, photographs=tuple(arguments.second), times=arguments.second_times)
        sides.append(SideSettings(second, arguments.second_circle, math.radians(arguments.turn)))
    settings = BallSettings(
        tuple(sides),
        arguments.size,
        arguments.distance,
        None if arguments.fov is None else math.radians(arguments.fov),
        math.radians(arguments.elevation),
        math.radians(arguments.camera),
    )
    found = console.steps(illuminate_from_ball(settings, arguments.output, arguments.force))
    for path, (x, y, radius) in found.circles:
        console.say(f"{path}: ball {x:.1f},{y:.1f},{radius:.1f}")
    console.say(f"{arguments.output}")
    return {
        "environment": str(arguments.output),
        "circles": [[str(path), *circle] for path, circle in found.circles],
        "gains": list(found.gains),
    }


def _circle(text: str) -> tuple[float, float, float]:
    """Three numbers, X,Y,R."""
    try:
        x, y, radius = (float(number) for number in text.split(","))
    except ValueError:
        raise argparse.ArgumentTypeError(f"'{text}' is not X,Y,R, three numbers") from None
    return x, y, radius
