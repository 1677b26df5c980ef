"""Write a map set's maps as textures for engines."""

import argparse
from typing import Any

from . import options
from .report import Report


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what `run` reads."""
    options.add_map_set(parser)
    options.add_output(parser, "OUT.ktx2", "the texture, with a note of what it holds")
    parser.add_argument(
        "--up",
        choices=["z", "y"],
        default="z",
        help="axis that points up: z as in Blender, y as in glTF; y for mip chains alone (default: z)",
    )


def run(arguments: argparse.Namespace, report: Report) -> dict[str, Any]:
    """Export.

    Returns
    -------
    dict
        "textures", the paths of the files that were written.

    Raises
    ------
    RsibrError
        See `tasks.export.export`.
    """
    from ..files.textures import Up
    from ..tasks.export.export import export
    from ..tasks.export.ktx2 import Ktx2Settings

    settings = Ktx2Settings(Up(arguments.up))
    textures = report.steps(export(arguments.map_set, arguments.output, settings, arguments.force))
    for texture in textures:
        report.say(f"{texture}")
    return {"textures": [str(texture) for texture in textures]}
