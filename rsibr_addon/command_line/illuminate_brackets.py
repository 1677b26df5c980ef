"""Merge photographs at several exposures into one picture of radiance."""

import argparse
from typing import Any

from .console import Console
from .illuminate_options import add_bracket, bracket_settings
from .options import add_output


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what `run` reads."""
    add_bracket(parser, "the photographs, all of one size, in any order")
    add_output(parser, "OUT.exr|OUT.hdr", "the picture to write, laid out as the photographs are")


def run(arguments: argparse.Namespace, console: Console) -> dict[str, Any]:
    """Merge.

    Returns
    -------
    dict
        "picture", its path; "saturated" and "black", shares of it that no photograph tells of; "moved",
        how far a corner moved at most from one photograph to another, in pixels.

    Raises
    ------
    RsibrError
        See `tasks.light.brackets`.
    """
    from ..tasks.light.brackets import illuminate_from_brackets

    settings = bracket_settings(arguments)
    merged = console.steps(illuminate_from_brackets(settings, arguments.output, arguments.force))
    height, width = merged.radiance.shape[:2]
    moved = max(motion.most(width, height) for motion in merged.motions)
    console.say(f"{arguments.output}")
    return {
        "picture": str(arguments.output),
        "saturated": merged.saturated,
        "black": merged.black,
        "moved": moved,
    }
