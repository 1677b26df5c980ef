"""The command `rsibr submit`."""

import argparse
import shlex
from pathlib import Path
from typing import Any

from .batch import add_batch, counted, listed
from .console import Console


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what `run` reads."""
    add_batch(parser)
    parser.add_argument(
        "--dry-run", action="store_true", help="list the bakes and what they cost, and send none"
    )
    parser.add_argument(
        "--program",
        metavar="WORDS",
        type=shlex.split,
        help="what starts rsibr on a machine of the farm, as 'blender --background --command rsibr'"
        " (default: rsibr)",
    )
    where = parser.add_mutually_exclusive_group(required=True)
    where.add_argument(
        "--openjd",
        metavar="FOLDER",
        type=Path,
        help="write a job bundle for Deadline Cloud or openjd run",
    )


def run(arguments: argparse.Namespace, console: Console) -> dict[str, Any]:
    """Send the batch.

    Returns
    -------
    dict
        "template", the path of a bundle's template.

    Raises
    ------
    RsibrError
        See `tasks.farm`.
    """
    from ..tasks.farm.folder import bakes_to_send
    from ..tasks.farm.openjd import write_bundle

    title, bakes = arguments.batch.stem, bakes_to_send(arguments.batch)
    if arguments.dry_run:
        return listed(bakes, console)
    program = arguments.program or ["rsibr"]
    template = console.steps(write_bundle(arguments.openjd, title, bakes, program))
    console.say(f"{template}: {counted(len(bakes), 'bake')}")
    return {"template": str(template)}
