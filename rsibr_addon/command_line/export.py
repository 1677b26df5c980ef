"""The command `rsibr export`."""

import argparse
from typing import Any

from ..tasks.export.formats import FORMATS
from . import options
from .console import Console


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what `run` reads."""
    options.add_map_set(parser)
    options.add_options_of(parser, {name: each.settings for name, each in FORMATS.items()})
    names = "|".join(f"OUT{each.suffix}" for each in FORMATS.values())
    options.add_output(parser, names, "the first file; its name tells the format")


def run(arguments: argparse.Namespace, console: Console) -> dict[str, Any]:
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
    from ..tasks.export.export import export, format_of

    owners = {name: each.settings for name, each in FORMATS.items()}
    settings = options.given_of(arguments, owners, format_of(arguments.output))
    textures = console.steps(export(arguments.map_set, arguments.output, settings, arguments.force))
    for texture in textures:
        console.say(f"{texture}")
    return {"textures": [str(texture) for texture in textures]}
