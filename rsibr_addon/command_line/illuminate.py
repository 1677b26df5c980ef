"""The command `rsibr illuminate`, which has one for each source of light."""

import argparse
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ..core.options import Options
from ..files.radiance_pictures import describe_radiance
from ..settings.environment import FacesSettings, PaintedSettings, SceneLight, WorldLight
from ..settings.photographs import BallBrackets, BallSettings, BracketSettings
from .console import Console
from .file_arguments import add_output
from .options import add_options, given

ENVIRONMENT = "the latitude-longitude map to write"
BLEND = ("FILE.blend", "the file that holds the scene")


@dataclass(frozen=True)
class IlluminateCommand:
    """The command of one way to make it: ``rsibr illuminate KIND``.

    Attributes
    ----------
    summary : str
        What it is made from, as a sentence.
    source : (str, str)
        Stands for the file that it is made from, and its help.
    make : callable
        Takes the arguments, the console and the options; returns what `run` does, but for the path.
    options : tuple of type
        Derived from `Options`.
    several : bool
        Whether it is made from one file or several.
    besides : mapping
        Other arguments -> what argparse is told of them.
    output : (str, str)
        Name of the path in the result, and the help.
    """

    summary: str
    source: tuple[str, str]
    make: Callable[..., dict[str, Any]]
    options: tuple[type[Options], ...]
    several: bool = False
    besides: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    output: tuple[str, str] = ("environment", ENVIRONMENT)

    def add_arguments(self, parser: argparse.ArgumentParser) -> None:
        """Declare what `run` reads."""
        metavar, text = self.source
        nargs = "+" if self.several else None
        parser.add_argument("source", metavar=metavar, nargs=nargs, type=Path, help=text)
        for options in self.options:
            add_options(parser, options)
        for flag, more in self.besides.items():
            parser.add_argument(flag, **more)
        add_output(parser, "OUT.exr|OUT.hdr", self.output[1])

    def run(self, arguments: argparse.Namespace, console: Console) -> dict[str, Any]:
        """Make it.

        Returns
        -------
        dict
            "environment" or "picture", the path of what was written, and "scale", what its header says of how
            bright it was made. Of faces "gains", three factors of each
            that it was scaled by. Of balls "circles", of each photograph its path and x, y and radius of
            the outline from its top left corner; and "gains", what each side was multiplied by. Of brackets
            "saturated" and "black", shares of the picture that no photograph tells of; and "moved", how far a
            corner moved at most from one photograph to another, in pixels.

        Raises
        ------
        RsibrError
            See `tasks.light`.
        """
        options = [given(arguments, each) for each in self.options]
        figures = self.make(arguments, console, *options)
        scale = describe_radiance(arguments.output).comments
        console.say(f"{arguments.output}: {scale}" if scale else f"{arguments.output}")
        return {self.output[0]: str(arguments.output), "scale": scale, **figures}


def _scene(arguments: argparse.Namespace, console: Console, settings: SceneLight) -> dict[str, Any]:
    from ..host.blend_files import open_blend
    from ..tasks.light.scene import illuminate_from_scene

    open_blend(arguments.source)
    console.steps(illuminate_from_scene(settings, arguments.output, arguments.force))
    return {}


def _world(arguments: argparse.Namespace, console: Console, settings: WorldLight) -> dict[str, Any]:
    from ..host.blend_files import open_blend
    from ..tasks.light.world import illuminate_from_world

    open_blend(arguments.source)
    console.steps(illuminate_from_world(settings, arguments.output, arguments.force))
    return {}


def _faces(arguments: argparse.Namespace, console: Console, settings: FacesSettings) -> dict[str, Any]:
    from ..tasks.light.faces import illuminate_from_faces

    made = illuminate_from_faces(arguments.source, settings, arguments.output, arguments.force)
    return {"gains": console.steps(made).tolist()}


def _ball(
    arguments: argparse.Namespace, console: Console, settings: BallSettings, brackets: BallBrackets
) -> dict[str, Any]:
    from ..tasks.light.ball import illuminate_from_ball

    sides = [side for side in (arguments.source, arguments.second) if side]
    made = illuminate_from_ball(sides, settings, arguments.output, arguments.force, brackets)
    found = console.steps(made)
    for path, (x, y, radius) in found.circles:
        console.say(f"{path}: ball {x:.1f},{y:.1f},{radius:.1f}")
    circles = [[str(path), *circle] for path, circle in found.circles]
    return {"circles": circles, "gains": list(found.gains)}


def _brackets(arguments: argparse.Namespace, console: Console, settings: BracketSettings) -> dict[str, Any]:
    from ..tasks.light.brackets import illuminate_from_brackets

    made = illuminate_from_brackets(arguments.source, settings, arguments.output, arguments.force)
    merged = console.steps(made)
    height, width = merged.radiance.shape[:2]
    moved = max(motion.most(width, height) for motion in merged.motions)
    return {"saturated": merged.saturated, "black": merged.black, "moved": moved}


def _painted(arguments: argparse.Namespace, console: Console, settings: PaintedSettings) -> dict[str, Any]:
    from ..tasks.light.painted import illuminate_from_painting

    console.steps(illuminate_from_painting(arguments.source, settings, arguments.output, arguments.force))
    return {}


KINDS = {
    "scene": IlluminateCommand(
        "Make it with Cycles around a point of a scene, from all that shines and reflects there.",
        BLEND,
        _scene,
        (SceneLight,),
        besides={
            "--panorama": {
                "dest": "faces",
                "action": "store_false",
                "default": argparse.SUPPRESS,
                "help": "as --no-faces",
            }
        },
    ),
    "world": IlluminateCommand(
        "Make it from the world of a scene alone, whatever its nodes.", BLEND, _world, (WorldLight,)
    ),
    "faces": IlluminateCommand(
        "Make it from six photographs that look along the axes.",
        (
            "NAME.jpg",
            "stands for NAME-px.jpg, NAME-nx.jpg, -py, -ny, -pz, -nz: right, left, up, down, ahead and back, "
            "square, 90 degrees wide, upright as one sees them; JPEG, PNG, OpenEXR, Radiance HDR",
        ),
        _faces,
        (FacesSettings,),
    ),
    "ball": IlluminateCommand(
        "Make it from photographs of a mirrored ball, from one side or from two.",
        ("PHOTO", "the photograph, or several at different exposures"),
        _ball,
        (BallSettings, BallBrackets),
        several=True,
        besides={
            "--second": {
                "metavar": "PHOTO",
                "nargs": "+",
                "type": Path,
                "help": "as PHOTO, from a second side, which shows what the first cannot",
            }
        },
    ),
    "brackets": IlluminateCommand(
        "Merge photographs at several exposures into one picture of radiance.",
        ("PHOTO", "the photographs, all of one size, in any order"),
        _brackets,
        (BracketSettings,),
        several=True,
        output=("picture", "the picture to write, laid out as the photographs are"),
    ),
    "painted": IlluminateCommand(
        "Make it from a painted picture, whose whites become lamps.",
        ("PICTURE", "JPEG, PNG and the like, of 8 or 16 bits"),
        _painted,
        (PaintedSettings,),
    ),
}
"""What it is made from -> the command."""
