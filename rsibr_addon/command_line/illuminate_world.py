"""Make it from the world of a scene alone, whatever its nodes."""

import argparse
from pathlib import Path
from typing import Any

from ..settings.light import Clamp
from .console import Console
from .illuminate_options import add_environment_output
from .options import add_options, given


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what `run` reads."""
    parser.add_argument("source", metavar="FILE.blend", type=Path, help="the file that holds the scene")
    parser.add_argument("--scene", metavar="NAME", help="which scene (default: the one it was saved with)")
    add_options(parser, Clamp)
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
        See `tasks.light.world`.
    """
    from ..host.blend_files import open_blend
    from ..tasks.light.world import illuminate_from_world

    open_blend(arguments.source)
    target = arguments.output, arguments.force, given(arguments, Clamp).clamp
    path = console.steps(illuminate_from_world(arguments.scene, arguments.size, *target))
    console.say(f"{path}")
    return {"environment": str(path)}
