"""The command `rsibr render`."""

import argparse
from pathlib import Path
from typing import Any

from ..settings.render import FramesOptions
from . import options
from .console import Console


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what `run` reads."""
    parser.add_argument("blend", metavar="FILE.blend", type=Path, help="the Blender file; it stays as it is")
    options.add_options(parser, FramesOptions)
    parser.add_argument(
        *("-o", "--output"),
        metavar="OUT.exr|OUT.png",
        required=True,
        help="EXR holds linear radiance, PNG what the scene's view transform makes of it; # stands for a "
        "digit of the frame, // in front for the folder of the Blender file",
    )
    parser.add_argument("--force", action="store_true", help="replace what exists")


def run(arguments: argparse.Namespace, console: Console) -> dict[str, Any]:
    """Render.

    Returns
    -------
    dict
        "pictures", the paths of the frames in their order.

    Raises
    ------
    RsibrError
        See `tasks.render.frames.render_frames`.
    """
    from ..tasks.render.frames import render_frames

    settings = options.given(arguments, FramesOptions)
    asked = arguments.blend, settings, arguments.output, arguments.force
    pictures = [str(path) for path in console.steps(render_frames(*asked))]
    for path in pictures:
        console.say(path)
    return {"pictures": pictures}
