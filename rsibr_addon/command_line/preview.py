"""Draw a mesh shaded from a map set, once or as a turntable."""

import argparse
from pathlib import Path
from typing import Any

from ..settings.light import Clamp
from . import looks, options
from .report import Report


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what `run` reads."""
    parser.add_argument(
        "map_set",
        metavar="NAME.rsibr.exr|PICTURE",
        type=Path,
        help="a map set; or a picture of an environment, OpenEXR or Radiance HDR, to be mirrored",
    )
    options.add_scene(parser, size=512)
    parser.add_argument(
        "--view",
        metavar="X,Y,Z",
        type=options.direction,
        default=(0.0, -1.0, 0.0),
        help="from the object to the eye (default: 0,-1,0, the front)",
    )
    parser.add_argument(
        "--turntable",
        metavar="N",
        type=options.positive,
        help="N frames around the object: a contact sheet in OUT and a movie beside it, OUT.mp4",
    )
    options.add_options(parser, Clamp)
    looks.add_arguments(parser)
    options.add_output(parser, "OUT.exr|OUT.png", "EXR holds linear radiance, and coverage in alpha")


def run(arguments: argparse.Namespace, report: Report) -> dict[str, Any]:
    """Draw the picture, or the turntable.

    Returns
    -------
    dict
        "picture", the path of the picture or contact sheet; of a turntable "movie" too.

    Raises
    ------
    RsibrError
        See `tasks.preview`.
    """
    from ..core.geometry.camera import Camera
    from ..tasks.methods.kinds import kind_of
    from ..tasks.preview import PreviewSettings, preview, turntable

    settings = PreviewSettings(
        camera=Camera(arguments.view, options.radians_or_none(arguments.perspective)),
        mesh=arguments.mesh,
        size=arguments.size,
        look=looks.look(arguments, kind_of(arguments.map_set)),
        clamp=options.given(arguments, Clamp).clamp,
    )
    target = arguments.output, arguments.force
    if arguments.turntable is None:
        picture = report.steps(preview(arguments.map_set, settings, *target))
        report.say(f"{picture}")
        return {"picture": str(picture)}
    sheet, movie = report.steps(turntable(arguments.map_set, settings, arguments.turntable, *target))
    report.say(f"{sheet}")
    report.say(f"{movie}")
    return {"picture": str(sheet), "movie": str(movie)}
