"""Render a material's radiance views with Cycles into a map set."""

import argparse
from typing import Any

from . import options
from .report import Report


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what `run` reads."""
    options.add_environment(parser)
    parser.add_argument(
        "--material",
        metavar="MATERIAL",
        required=True,
        help="a preset (mirror, copper, plastic, car-paint), FILE.blend:NAME, or :NAME of the open file",
    )
    parser.add_argument(
        "--views",
        type=int,
        choices=[12, 42, 162],
        default=12,
        help="how many directions (default: %(default)s)",
    )
    parser.add_argument(
        "--size",
        metavar="N",
        type=options.positive,
        default=256,
        help="of a view, in texels (default: %(default)s)",
    )
    options.add_rendering(parser, samples=64)
    parser.add_argument("--denoise", action="store_true", help="denoise each view")
    options.add_output(parser, "NAME.rsibr.exr", "the map set to write")


def run(arguments: argparse.Namespace, report: Report) -> dict[str, Any]:
    """Capture; when it was interrupted before, go on with the views that are missing.

    Returns
    -------
    dict
        "map_set", the path of the file.
    """
    from ..job import CaptureJob
    from ..tasks.methods.radiance_views import capture

    job = CaptureJob(
        environment=arguments.environment,
        material=arguments.material,
        views=arguments.views,
        size=arguments.size,
        samples=arguments.samples,
        denoise=arguments.denoise,
        seed=arguments.seed,
        output=str(arguments.output),
        force=arguments.force,
        clamp=arguments.clamp,
    )
    path = report.steps(capture(job))
    report.say(f"{path}: {job.views} views of {job.size}x{job.size}")
    return {"map_set": str(path)}
