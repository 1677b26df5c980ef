"""The command `rsibr submit`."""

import argparse
import shlex
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..core.counted import counted
from ..core.errors import RangeError
from ..core.warned import warn
from .batch import add_batch, check_failures, listed, together
from .console import Console

if TYPE_CHECKING:
    from ..tasks.batch.bakes import BatchBake


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what `run` reads."""
    add_batch(parser)
    where = parser.add_mutually_exclusive_group(required=True)
    where.add_argument(
        "--flamenco", metavar="URL", help="the address of a Flamenco manager, as http://farm:8080"
    )
    where.add_argument(
        "--openjd",
        metavar="FOLDER",
        type=Path,
        help="write a job bundle for Deadline Cloud or openjd run",
    )
    parser.add_argument(
        "--dry-run", action="store_true", help="list the bakes and what they cost, and send none"
    )
    parser.add_argument(
        "--program",
        metavar="WORDS",
        help="what starts rsibr on a machine of the farm (default: rsibr, and with --flamenco its variable "
        "{blender} with --background --disable-autoexec --command rsibr)",
    )
    parser.add_argument(
        "--shared",
        metavar="FOLDER",
        type=Path,
        help="with --flamenco: the farm's shared storage, by its path here (default: as the manager says)",
    )
    parser.add_argument(
        "--wait",
        action="store_true",
        help="with --flamenco: wait for the end, and fetch the map sets; when interrupted, cancel the job",
    )


def run(arguments: argparse.Namespace, console: Console) -> dict[str, Any]:
    """Send the batch.

    Returns
    -------
    dict
        "template", the path of a bundle's template. Of a job of Flamenco "job", its number, "page", its
        address, and "maps", the folder of the map sets.

    Raises
    ------
    RsibrError
        See `tasks.farm`; or bakes failed that were waited for, which the message names.
    """
    from ..tasks.batch.faults import fault_of
    from ..tasks.farm.folder import bakes_to_send
    from ..tasks.farm.openjd import write_bundle

    title, folder, bakes = bakes_to_send(arguments.batch)
    if arguments.dry_run:
        return listed(bakes, console)
    for sentence in together({bake.job.output: fault for bake in bakes if (fault := fault_of(bake))}):
        warn(sentence)
    if arguments.flamenco is not None:
        return _sent(arguments, title, bakes, folder, console)
    if arguments.shared or arguments.wait:
        raise RangeError("--shared and --wait are for --flamenco: leave them out, as nothing is sent yet.")
    program = shlex.split(arguments.program or "rsibr")
    template = console.steps(write_bundle(arguments.openjd, title, bakes, program))
    console.say(f"{template}: {counted(len(bakes), 'bake')}")
    return {"template": str(template)}


def _sent(
    arguments: argparse.Namespace, title: str, bakes: list["BatchBake"], folder: Path, console: Console
) -> dict[str, Any]:
    from ..tasks.farm.flamenco import Manager
    from ..tasks.farm.send import PROGRAM, bake_on_farm, send

    if "bpy" in sys.modules:
        from ..host.preferences import check_online

        check_online()
    manager, program = Manager(arguments.flamenco), arguments.program or PROGRAM
    if arguments.wait:
        steps = bake_on_farm(manager, title, bakes, folder, arguments.shared, program)
        sent, failures = console.steps(steps)
        check_failures(failures, len(bakes), sent.page)
    else:
        sent = console.steps(send(manager, title, bakes, arguments.shared, program))
    console.say(f"{sent.page}: {counted(len(bakes), 'bake')}, with the map sets in {sent.maps}")
    return {"job": sent.number, "page": sent.page, "maps": str(sent.maps)}
