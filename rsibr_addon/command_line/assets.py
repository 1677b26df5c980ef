"""The command `rsibr assets`."""

import argparse
from typing import Any

from .console import Console
from .file_arguments import add_output


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what `run` reads."""
    add_output(parser, "NAME.blend", "the file to write; put it into the folder of an asset library")


def run(arguments: argparse.Namespace, console: Console) -> dict[str, Any]:
    """Write the materials.

    Returns
    -------
    dict
        "assets", the path of the file; "materials", their names.

    Raises
    ------
    RsibrError
        See `tasks.assets.write_assets`.
    """
    from ..tasks.assets import write_assets

    names = console.steps(write_assets(arguments.output, arguments.force))
    console.say(f"{arguments.output}: {len(names)} materials")
    return {"assets": str(arguments.output), "materials": names}
