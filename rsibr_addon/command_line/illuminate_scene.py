"""Make it with Cycles around a point of a scene, from all that shines and reflects there."""

import argparse
from pathlib import Path
from typing import Any

from . import options
from .console import Console
from .illuminate_options import add_environment_output


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what `run` reads."""
    parser.add_argument("source", metavar="FILE.blend", type=Path, help="the file that holds the scene")
    parser.add_argument("--scene", metavar="NAME", help="which scene (default: the one it was saved with)")
    parser.add_argument(
        "--object",
        metavar="NAME",
        help="the object that will be lit: it is left out, with its children and instances, and the map is "
        "made around its middle",
    )
    parser.add_argument(
        "--point",
        metavar="X,Y,Z",
        type=options.position,
        help="where the map is made (default: the middle of the object, or else the 3D cursor)",
    )
    parser.add_argument("--frame", metavar="N", type=int, help="when (default: the frame it was saved at)")
    how = parser.add_mutually_exclusive_group()
    how.add_argument("--panorama", action="store_true", help="render a panorama, as is done without --faces")
    how.add_argument("--faces", action="store_true", help="render the six faces of a cube")
    options.add_rendering(parser, samples=128)
    parser.add_argument("--denoise", action="store_true", help="denoise what is rendered")
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
        See `tasks.light.scene`.
    """
    from ..host.blend_files import open_blend
    from ..tasks.light.scene import SceneLight, illuminate_from_scene

    light = SceneLight(
        size=arguments.size,
        samples=arguments.samples,
        scene=arguments.scene,
        subject=arguments.object,
        point=arguments.point,
        frame=arguments.frame,
        faces=arguments.faces,
        denoise=arguments.denoise,
        seed=arguments.seed,
    )
    open_blend(arguments.source)
    path = console.steps(illuminate_from_scene(light, arguments.output, arguments.force))
    console.say(f"{path}")
    return {"environment": str(path)}
