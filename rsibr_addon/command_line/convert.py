"""The command `rsibr convert`."""

import argparse
from pathlib import Path
from typing import Any

from ..settings.convert import ConvertSettings
from .console import Console
from .options import add_options, given


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what `run` reads."""
    parser.add_argument(
        "source",
        metavar="IN",
        type=Path,
        help="OpenEXR, Radiance HDR, or a picture such as JPEG; for cube_faces NAME.exr, which stands for "
        "NAME-px.exr, NAME-nx.exr, -py, -ny, -pz, -nz; for dual_paraboloid and orthographic NAME.exr, for "
        "NAME-front.exr and NAME-back.exr",
    )
    parser.add_argument(
        "output", metavar="OUT.exr|OUT.hdr", type=Path, help="the new map, named in the same way"
    )
    add_options(parser, ConvertSettings)
    parser.add_argument("--force", action="store_true", help="replace what exists")


def run(arguments: argparse.Namespace, console: Console) -> dict[str, Any]:
    """Convert.

    Returns
    -------
    dict
        "pictures", the paths of the files that were written.

    Raises
    ------
    RsibrError
        See `tasks.light.convert`.
    """
    from ..tasks.light.convert import convert

    settings = given(arguments, ConvertSettings)
    pictures = console.steps(convert(arguments.source, settings, arguments.output, arguments.force))
    for picture in pictures:
        console.say(f"{picture}")
    return {"pictures": [str(picture) for picture in pictures]}
