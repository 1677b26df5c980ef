"""The command `rsibr preview`."""

import argparse
from typing import Any

from ..files.kinds.registry import look_types
from ..settings.drawing import PreviewOptions
from . import options
from .console import Console
from .file_arguments import add_map_set_or_light, add_output, map_set_or_light


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what `run` reads."""
    add_map_set_or_light(parser, "to be mirrored")
    options.add_options(parser, PreviewOptions)
    options.add_options_of(parser, look_types())
    add_output(parser, "OUT.exr|OUT.png", "EXR holds linear radiance, and coverage in alpha")


def run(arguments: argparse.Namespace, console: Console) -> dict[str, Any]:
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
    from ..tasks.methods.kinds import kind_of
    from ..tasks.preview import preview, turntable

    source, settings = map_set_or_light(arguments), options.given(arguments, PreviewOptions)
    look = options.given_of(arguments, look_types(), kind_of(source))
    asked = source, settings, arguments.output, arguments.force, look
    if settings.turntable is None:
        made = [console.steps(preview(*asked))]
    else:
        made = [*console.steps(turntable(*asked))]
    for path in made:
        console.say(f"{path}")
    return dict(zip(("picture", "movie"), map(str, made), strict=False))
