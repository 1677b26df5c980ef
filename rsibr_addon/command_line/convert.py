"""Lay a map of light out in another representation."""

import argparse
from pathlib import Path
from typing import Any

from ..settings.light import Clamp
from .console import Console
from .options import add_options, given, positive

LAYOUTS = (
    "equirect",
    "sphere_map",
    "mirror_ball",
    "angular_map",
    "dual_paraboloid",
    "orthographic",
    "octahedral",
    "cube_faces",
    "cube_cross",
    "cube_strip",
)


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
    parser.add_argument("output", metavar="OUT.exr|OUT.hdr", type=Path, help="named as IN")
    for option, description in (("--from", "how IN is laid out"), ("--to", "how OUT shall be laid out")):
        parser.add_argument(
            option,
            metavar="LAYOUT",
            dest=f"{option[2:]}_layout",
            choices=LAYOUTS,
            required=True,
            help=f"{description}: {', '.join(LAYOUTS)}",
        )
    parser.add_argument(
        "--size",
        metavar="N",
        type=positive,
        required=True,
        help="width in texels of OUT, or of each of its faces or sheets; equirect is half as high",
    )
    parser.add_argument(
        "--overscan",
        metavar="X",
        type=float,
        help="half-width of a dual_paraboloid's sheets in radii of the hemisphere (default: 1)",
    )
    parser.add_argument(
        "--distance",
        metavar="X",
        type=float,
        help="of the camera from a mirror_ball's centre in radii of the ball (default: infinite)",
    )
    add_options(parser, Clamp)
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
    from ..tasks.light.convert import ConvertSettings, convert

    settings = ConvertSettings(
        source=arguments.from_layout,
        target=arguments.to_layout,
        size=arguments.size,
        overscan=arguments.overscan,
        distance=arguments.distance,
        clamp=given(arguments, Clamp).clamp,
    )
    pictures = console.steps(convert(arguments.source, settings, arguments.output, arguments.force))
    for picture in pictures:
        console.say(f"{picture}")
    return {"pictures": [str(picture) for picture in pictures]}
