"""The command `rsibr job`."""

import argparse
import contextlib
import io
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ..core.errors import InputFileError
from ..files.reading import read_text
from ..job import BakeJob, job_of_object, read_job
from ..settings.baked_inputs import ObjectInputsSettings
from .bake import run_job
from .console import Console
from .parser import UsageError

REASON_LETTERS = 500
"""Greatest length of argparse's message, which repeats what is wrong."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what `run` reads."""
    parser.add_argument("job", metavar="JOB.json", type=Path, help="the job, as JSON")


def run(arguments: argparse.Namespace, console: Console) -> dict[str, Any]:
    """Do the job.

    Returns
    -------
    dict
        What the job's own command returns.

    Raises
    ------
    InputFileError
        The file is missing, no job, or a job that its command does not understand.
    RsibrError
        See the job's command.
    """
    job = read_job(_text(arguments.job), str(arguments.job))
    if isinstance(job, BakeJob):
        return run_job(_of_its_object(job), console)
    asked = _parsed(job.arguments, arguments.job)
    if hasattr(asked, "if_missing"):
        asked.if_missing = not asked.force
    result: dict[str, Any] = asked.run(asked, console)
    return result


def _of_its_object(job: BakeJob[Any]) -> BakeJob[Any]:
    """The job as it is, or under the name of the object whose inputs it bakes."""
    is_of_object = job.settings.KIND == ObjectInputsSettings.KIND
    return job_of_object(job, job.settings.object) if is_of_object else job


def _text(path: Path) -> str:
    try:
        return read_text(path)
    except UnicodeDecodeError as error:
        raise InputFileError(f"{path} is no text: give a job, which is JSON in UTF-8.") from error


def _parsed(argv: Sequence[str], path: Path) -> argparse.Namespace:
    """What a job's arguments ask for; of a usage that is wrong, the parser's own words."""
    from .commands import parsed

    try:
        with contextlib.redirect_stdout(io.StringIO()):
            asked = parsed(argv)
    except (UsageError, SystemExit) as error:
        reason = "it asks for help" if isinstance(error, SystemExit) else str(error)[:REASON_LETTERS]
        raise InputFileError(f"{path} cannot be done ({reason}): correct it.") from error
    if asked.run is run:
        raise InputFileError(f"{path} is a job whose work is another job: give that one.")
    return asked
