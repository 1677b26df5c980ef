"""The command `rsibr batch`."""

import argparse
import sys
from pathlib import Path
from typing import Any

from ..core.errors import NotNowError, RsibrError
from ..core.warned import warn
from .console import Console


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what `run` reads."""
    parser.add_argument(
        "batch",
        metavar="BATCH.json|BATCH.csv",
        type=Path,
        help="environments, materials, methods and a pattern of outputs; a map set that exists and was made "
        "with the same settings is kept",
    )
    parser.add_argument(
        "--dry-run", action="store_true", help="list the bakes and what they cost, and do none"
    )


def run(arguments: argparse.Namespace, console: Console) -> dict[str, Any]:
    """Do the batch, or list it.

    Returns
    -------
    dict
        "page", the path of the page that shows all; "made" and "found", numbers of bakes that were done, and
        that were there already. Of a dry run "bakes", the paths of the map sets; "processor_seconds" and
        "disk", what they cost together.

    Raises
    ------
    RsibrError
        See `tasks.batch.description.read_batch` and `tasks.batch.run.run_batch`; or bakes failed, which the
        message names.
    """
    from ..tasks.batch.description import read_batch
    from ..tasks.batch.run import run_batch

    bakes = read_batch(arguments.batch)
    if arguments.dry_run:
        return _listed(bakes, console)
    result = console.steps(run_batch(arguments.batch, bakes, _worker_command()))
    for output, failure in sorted(result.failures.items()):
        warn(f"{output}: {failure['error']}")
    if result.failures:
        kind = NotNowError if all(each["try_again"] for each in result.failures.values()) else RsibrError
        names = ", ".join(sorted(result.failures))
        raise kind(f"{len(result.failures)} of {len(bakes)} bakes failed ({names}): see {result.page}.")
    console.say(f"{result.page}: {len(bakes)} bakes, {result.found} of them there already")
    return {"page": str(result.page), "made": result.made, "found": result.found}


def _listed(bakes: list[Any], console: Console) -> dict[str, Any]:
    from ..tasks.batch.run import cost_of

    costs = [cost for cost in map(cost_of, bakes) if cost]
    for bake in bakes:
        there = ", exists" if Path(bake.job.output).exists() else ""
        console.say(f"{bake.job.output}: {bake.job.settings.LABEL}, {bake.title}{there}")
    seconds, disk = sum(cost.processor_seconds for cost in costs), sum(cost.disk for cost in costs)
    environments = len({bake.job.light.environment for bake in bakes})
    console.say(
        f"{len(bakes)} bakes in {environments} environments: about {seconds:.0f} s of processors and "
        f"{disk / 1e6:.0f} MB on disk"
    )
    outputs = [bake.job.output for bake in bakes]
    return {"bakes": outputs, "processor_seconds": seconds, "disk": disk}


def _worker_command() -> list[str]:
    """What starts a worker: this Blender, if it is one, or this Python."""
    code = f"from {__package__}.worker import serve; serve()"
    if "bpy" in sys.modules:
        from ..host.bake_settings import EXTENSION, blender_program

        if program := blender_program():
            quiet = (program, "--background", "--disable-autoexec")
            return [*quiet, "--addons", EXTENSION, "--python-expr", code]
    return [sys.executable, "-c", code]
