"""A batch from its file to all its map sets and a page that shows them."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ...core.errors import RsibrError
from ...core.progress import Progress, Steps
from ...core.threads import thread_count
from ...files.memory import memory_left
from ...files.outputs import make_folder, together
from ..methods.bake import METHODS
from ..methods.method import Cost
from .bakes import BatchBake
from .faults import fault_of
from .index import write_index
from .notes import Failure, Note, read_failure, read_note, stamp_of, write_note
from .summary import SUMMARY, Outcome, outcomes_of, write_summary
from .workers import Worker, started_workers

UNKNOWN = Failure(error="It has not been done: do its part again.", try_again=True)

ENDED = "Its process ended before it was done, as when memory is short: bake it alone to see why."


@dataclass
class BatchResult:
    """What has become of a batch.

    Attributes
    ----------
    page : Path
        Where all is shown.
    outcomes : list of Outcome
        What is told of each bake, once the page is written.
    made, found : int
        Bakes that were done, and that were there already.
    failures : dict of str to Failure
        By output.
    """

    page: Path
    outcomes: list[Outcome] = field(default_factory=list)
    made: int = 0
    found: int = 0
    failures: dict[str, Failure] = field(default_factory=dict)

    @property
    def ended(self) -> int:
        """Bakes of which it is known."""
        return self.made + self.found + len(self.failures)


def cost_of(bake: BatchBake) -> Cost | None:
    """What a bake will take; None where its settings describe no material."""
    try:
        return METHODS[bake.job.settings.KIND].cost(bake.job.settings)
    except RsibrError:
        return None


def run_bakes(folder: Path, bakes: Sequence[BatchBake], command: Sequence[str]) -> Steps[BatchResult]:
    """Do the bakes of a batch, or of a part of it, that are not done, on all cores.

    Parameters
    ----------
    folder : Path
        From `batch_folder`; it keeps what becomes of each bake.
    bakes : sequence of BatchBake
    command : sequence of str
        Starts a worker: see `command_line.worker`.

    Raises
    ------
    OutputFileError
        A folder cannot be made, or what became of a bake not be written.

    Notes
    -----
    A bake that fails stops no other. Each worker goes on with the environment that it has read, and takes
    another one that nobody works on, while there are such.
    """
    for each in {folder, *(Path(bake.job.output).parent for bake in bakes)}:
        make_folder(each)
    result, waiting = BatchResult(folder / "index.html"), list(bakes)
    count = _worker_count(bakes)
    with started_workers(command, max(1, thread_count() // count)) as workers:
        team = [workers.start() for _ in range(count)]
        for worker in team:
            _give_next(worker, team, waiting, folder)
        while any(worker.bake for worker in team):
            for worker, said in workers.heard():
                bake = worker.bake
                if bake is None:
                    continue
                if said is None:
                    _fail(bake, Failure(error=ENDED, try_again=True), folder, result)
                    team.remove(worker)
                    if waiting:
                        team.append(worker := workers.start())
                elif "result" in said:
                    _take(bake, said["result"], folder, result)
                else:
                    yield Progress(result.ended, len(bakes), f"{bake.title}: {said['progress']['what']}")
                    continue
                _give_next(worker, team, waiting, folder)
            yield Progress(result.ended, len(bakes), _told(team))
    return result


def write_page(folder: Path, title: str, bakes: Sequence[BatchBake]) -> BatchResult:
    """Write the page of a batch, and its summary beside it, of what its folder keeps of the bakes.

    Parameters
    ----------
    folder : Path
        From `batch_folder`.
    title : str
    bakes : sequence of BatchBake
        All of the batch.

    Returns
    -------
    BatchResult
        A bake of which nothing is kept has failed, and may be tried again.

    Raises
    ------
    OutputFileError
    """
    make_folder(folder)
    result = kept_result(folder, bakes)
    notes = [read_note(folder, bake) for bake in bakes]
    result.outcomes = outcomes_of(folder, bakes, notes, result.failures)
    with together():
        write_index(result.page, title, bakes, notes, result.failures)
        write_summary(folder / SUMMARY, result.outcomes)
    return result


def kept_result(folder: Path, bakes: Sequence[BatchBake]) -> BatchResult:
    """What has become of a batch, by what its folder keeps.

    Parameters
    ----------
    folder : Path
        From `batch_folder`.
    bakes : sequence of BatchBake
    """
    result = BatchResult(folder / "index.html")
    for bake in bakes:
        failure = read_failure(folder, bake) or (None if Path(bake.job.output).exists() else UNKNOWN)
        if failure and read_note(folder, bake) is None:
            result.failures[bake.job.output] = failure
    result.found = len(bakes) - len(result.failures)
    return result


def _worker_count(bakes: Sequence[BatchBake]) -> int:
    """As many as there are processors, and as memory is enough for the largest bakes."""
    memory = max((cost.memory for cost in map(cost_of, bakes) if cost), default=0.0)
    fitting = memory_left() / memory if memory else math.inf
    return int(max(1, min(thread_count(), len(bakes), fitting)))


def _give_next(worker: Worker, team: list[Worker], waiting: list[BatchBake], folder: Path) -> None:
    """Let a worker go on in the environment that it knows, or else in one that nobody works on, or in any."""
    worker.bake = None
    if not waiting:
        return
    others = {other.environment for other in team if other.bake}

    def rank(bake: BatchBake) -> tuple[bool, bool]:
        environment = bake.job.light.environment
        return environment != worker.environment, environment in others

    bake = min(waiting, key=rank)
    waiting.remove(bake)
    worker.give(bake, picture=read_note(folder, bake) is None)


def _take(bake: BatchBake, said: dict[str, Any], folder: Path, result: BatchResult) -> None:
    """Note what has become of a bake."""
    if not said["ok"]:
        error = fault_of(bake) or said["error"]  # a fault's words know the names that a batch takes
        _fail(bake, Failure(error=error, try_again=said["try_again"]), folder, result)
        return
    result.found += said["found"]
    result.made += not said["found"]
    # Another machine may have made it meanwhile, and know more
    if "picture" not in said or (said["found"] and read_note(folder, bake)):
        return
    note = Note(
        stamp=stamp_of(bake),
        told=said["told"],
        seconds=0.0 if said["found"] else said["seconds"],
        processor=0.0 if said["found"] else said["processor"],
        errors=said["errors"],
        warnings=said["warnings"],
        picture=said["picture"],
    )
    write_note(folder, bake, note)


def _fail(bake: BatchBake, failure: Failure, folder: Path, result: BatchResult) -> None:
    result.failures[bake.job.output] = failure
    write_note(folder, bake, failure)


def _told(team: list[Worker]) -> str:
    return ", ".join(worker.bake.title for worker in team if worker.bake)
