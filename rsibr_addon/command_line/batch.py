"""The command `rsibr batch`."""

import argparse
import sys
from collections.abc import Mapping, Sequence
from os.path import normpath
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..core.counted import counted, in_short
from ..core.errors import InputFileError, NotNowError, RsibrError
from ..core.near_names import did_you_mean
from ..core.warned import warn
from .console import Console

if TYPE_CHECKING:
    from ..tasks.batch.bakes import BatchBake
    from ..tasks.batch.notes import Failure


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what `run` reads."""
    add_batch(parser)
    parser.add_argument(
        "--output",
        metavar="FOLDER",
        type=Path,
        help="where the map sets and the page go (default: beside the batch)",
    )
    how = parser.add_mutually_exclusive_group()
    how.add_argument("--dry-run", action="store_true", help="list the bakes and what they cost, and do none")
    how.add_argument(
        "--part",
        metavar="NAME",
        help="do the bakes of one environment and method alone, as --dry-run names them, and write no page; "
        "it fails only if another try may help",
    )
    how.add_argument(
        "--page",
        action="store_true",
        help="write the page alone, and fail if a bake has failed or is missing",
    )


def add_batch(parser: argparse.ArgumentParser) -> None:
    """Declare the batch of a command."""
    parser.add_argument(
        "batch",
        metavar="BATCH.json|BATCH.csv",
        type=Path,
        help="environments, materials, methods and a pattern of outputs; a map set that exists and was made "
        "with the same settings is kept",
    )


def run(arguments: argparse.Namespace, console: Console) -> dict[str, Any]:
    """Do the batch, a part of it, or its page; or list it.

    Returns
    -------
    dict
        "page", the path of the page that shows all; "summary", that of the file that tells programs of each
        bake; "made" and "found", numbers of bakes that were done, and that were there already. Of a dry run
        "bakes", the paths of the map sets; "processor_seconds" and "disk", what they cost together; "parts",
        the names of the parts; "faults", why bakes will fail, by their paths.

    Raises
    ------
    RsibrError
        See `tasks.batch.description.read_batch` and `tasks.batch.run`; or bakes failed, which the message
        names.
    """
    from ..tasks.batch.description import read_batch
    from ..tasks.batch.notes import batch_folder
    from ..tasks.batch.run import run_bakes, write_page
    from ..tasks.batch.summary import SUMMARY, worst_of

    outputs = arguments.output or arguments.batch.parent
    bakes = read_batch(arguments.batch, outputs)
    if arguments.dry_run:
        return listed(bakes, console)
    folder = batch_folder(arguments.batch, outputs)
    if arguments.part is not None:
        return _run_part(arguments.part, bakes, folder, console)
    result = None
    if not arguments.page:
        result = console.steps(run_bakes(folder, bakes, _worker_command()))
    page = write_page(folder, arguments.batch.stem, bakes)
    check_failures(page.failures, len(bakes), str(page.page))
    for method, name, outcome in worst_of(page.outcomes):
        path, error = normpath(folder / outcome["map_set"]), outcome["errors"][name]
        console.say(f"{method}, greatest error, {name.replace('_', ' ')}: {error:.2g}, {path}")
    made = result.made if result else 0
    console.say(f"{page.page}: {counted(len(bakes), 'bake')}, {len(bakes) - made} of them there already")
    summary = str(page.page.with_name(SUMMARY))
    return {"page": str(page.page), "summary": summary, "made": made, "found": len(bakes) - made}


def check_failures(failures: Mapping[str, "Failure"], total: int, page: str) -> None:
    """Tell of bakes that failed, of so many.

    Raises
    ------
    RsibrError
        There are such; a NotNowError, where another try may help with all.
    """
    if not failures:
        return
    if total == 1:
        [failure] = failures.values()
        raise _failed(failures, failure["error"])
    _warn_of(failures)
    names = in_short(sorted(failures))
    raise _failed(failures, f"{len(failures)} of {total} bakes failed ({names}): see {page}.")


def _run_part(name: str, bakes: Sequence["BatchBake"], folder: Path, console: Console) -> dict[str, Any]:
    from ..tasks.batch.bakes import parts_of
    from ..tasks.batch.run import run_bakes

    parts = parts_of(bakes)
    if name not in parts:
        raise InputFileError(
            f"There is no part {name}{did_you_mean(name, parts)}: choose one that --dry-run lists."
        )
    result = console.steps(run_bakes(folder, parts[name], _worker_command()))
    _warn_of(result.failures)
    passing = {output: failure for output, failure in result.failures.items() if failure["try_again"]}
    if passing:
        raise _failed(passing, f"{counted(len(passing), 'bake')} of part {name} failed: give it again.")
    console.say(f"{name}: {counted(len(parts[name]), 'bake')}, {result.found} of them there already")
    return {"page": str(result.page), "made": result.made, "found": result.found}


def _warn_of(failures: Mapping[str, "Failure"]) -> None:
    for sentence in together({output: failure["error"] for output, failure in sorted(failures.items())}):
        warn(sentence)


def together(reasons: Mapping[str, str]) -> list[str]:
    """Sentences that say why bakes fail, each reason once.

    Parameters
    ----------
    reasons : mapping of str to str
        By output.
    """
    outputs: dict[str, list[str]] = {}
    for output, reason in reasons.items():
        outputs.setdefault(reason, []).append(output)
    return [f"{', '.join(names)}: {reason}" for reason, names in outputs.items()]


def _failed(failures: Mapping[str, "Failure"], sentence: str) -> RsibrError:
    """The error of bakes that failed: whether another try may help."""
    kind = NotNowError if all(each["try_again"] for each in failures.values()) else RsibrError
    return kind(sentence)


def listed(bakes: Sequence["BatchBake"], console: Console) -> dict[str, Any]:
    """List a batch's parts and bakes, with what they cost."""
    from ..tasks.batch.bakes import parts_of
    from ..tasks.batch.faults import fault_of
    from ..tasks.batch.run import cost_of

    parts = parts_of(bakes)
    faults: dict[str, str] = {}
    total, disk = 0.0, 0.0
    for name, part in parts.items():
        costs = [cost for cost in map(cost_of, part) if cost]
        seconds = sum(cost.processor_seconds for cost in costs)
        total, disk = total + seconds, disk + sum(cost.disk for cost in costs)
        console.say(f"{name}: {counted(len(part), 'bake')}, about {seconds:.0f} s of processors")
        for bake in part:
            there = ", exists" if Path(bake.job.output).exists() else ""
            if fault := fault_of(bake):
                faults[bake.job.output] = fault
            broken = ", will fail" if fault else ""
            console.say(f"  {bake.job.output}: {bake.job.settings.LABEL}, {bake.title}{there}{broken}")
    for sentence in together(faults):
        console.say(sentence)
    summary = f"{counted(len(bakes), 'bake')} in {counted(len(parts), 'part')}"
    console.say(f"{summary}: about {total:.0f} s of processors and {disk / 1e6:.0f} MB on disk")
    outputs = [bake.job.output for bake in bakes]
    return {
        "bakes": outputs,
        "parts": list(parts),
        "faults": faults,
        "processor_seconds": total,
        "disk": disk,
    }


def _worker_command() -> list[str]:
    """What starts a worker: this Blender, if it is one, or this Python."""
    code = f"from {__package__}.worker import serve; serve()"
    if "bpy" in sys.modules:
        from ..host.installation import blender_program
        from ..host.preferences import EXTENSION

        if program := blender_program():
            quiet = (program, "--background", "--disable-autoexec")
            return [*quiet, "--addons", EXTENSION, "--python-expr", code]
    return [sys.executable, "-c", code]
