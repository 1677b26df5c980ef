"""The command `rsibr inputs`."""

import argparse
from typing import Any

from ..core.options import to_plain
from ..job import BakeJob
from ..settings.baked_inputs import BakedInputsSettings, ObjectInputsSettings
from .bake import run_job
from .console import Console
from .file_arguments import add_output
from .options import add_options, given


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
        See `run_job`: "baked_inputs", and "pictures", the number of them.

    Raises
    ------
    RsibrError
        See `tasks.baked_inputs.bake_inputs`.
    """
    pictures = to_plain(given(arguments, BakedInputsSettings))
    settings = ObjectInputsSettings(object=arguments.object, **pictures)
    return run_job(BakeJob(settings, str(arguments.output), force=arguments.force), console)
