"""The command `rsibr inputs`."""

import argparse
from typing import Any

from ..settings.baked_inputs import BakedInputsSettings
from .console import Console
from .options import add_options, add_output, given


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what `run` reads."""
    parser.add_argument(
        "object", metavar="OBJECT", help="an object's name, in the file that Blender has open"
    )
    add_options(parser, BakedInputsSettings)
    add_output(parser, "NAME.exr", "the file to write; previews in viewports find theirs by themselves")


def run(arguments: argparse.Namespace, console: Console) -> dict[str, Any]:
    """Bake.

    Returns
    -------
    dict
        "baked_inputs", the path of the file; "pictures", the number of them.

    Raises
    ------
    RsibrError
        See `tasks.baked_inputs.bake_inputs`.
    """
    from ..tasks.baked_inputs import bake_inputs

    settings = given(arguments, BakedInputsSettings)
    baked = console.steps(bake_inputs(arguments.object, settings, arguments.output, arguments.force))
    count = len(baked.pictures)
    console.say(f"{arguments.output}: {count} {'picture' if count == 1 else 'pictures'}")
    return {"baked_inputs": str(arguments.output), "pictures": count}
