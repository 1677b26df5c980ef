"""A batch through Flamenco: sent, watched, and fetched."""

import shutil
import time
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from filecmp import cmp
from pathlib import Path

from ...core.errors import FarmError, NotNowError, OutputFileError
from ...core.progress import Progress, Steps
from ...core.warned import warn
from ...files.atomic import written_aside
from ...files.map_set import is_whole_map_set, read_map_set_header
from ...files.outputs import made_folders, make_folder
from ...settings.baked_inputs import ObjectInputsSettings
from ..batch.bakes import BatchBake, parts_of
from ..batch.notes import Failure, batch_folder
from ..batch.run import UNKNOWN, kept_result
from ..batch.summary import SUMMARY
from ..methods.recipe import check_made_by
from .flamenco import FarmTask, Manager
from .folder import INPUTS, MAPS, batch_name, folder_name, write_inputs

PROGRAM = "{blender} --background --disable-autoexec --command rsibr"
"""What starts rsibr on a worker, by Flamenco's variable of the program."""

LOOK_SECONDS = 2.0
"""Between two looks at a job."""

STEP_SECONDS = 0.1
"""Between two steps of waiting: so soon is an interruption noticed."""

LAST_TASK = "page"
"""The task of a job that depends on all others."""

ENDS = ("completed", "failed", "canceled")
"""Statuses of jobs and tasks that have ended."""


@dataclass(frozen=True)
class Sent:
    """A job of a farm.

    Attributes
    ----------
    number : str
        The farm's.
    name : str
        Of the batch.
    page : str
        Address of the farm's page of it.
    maps : Path
        Where its map sets will be.
    bakes : list of BatchBake
        With outputs in `maps`.
    """

    number: str
    name: str
    page: str
    maps: Path
    bakes: list[BatchBake]

    @property
    def folder(self) -> Path:
        """Where its page will be, and what becomes of each bake."""
        return batch_folder(Path(f"{self.name}.json"), self.maps)


def send(
    manager: Manager, title: str, bakes: Sequence[BatchBake], shared: Path | None, program: str
) -> Steps[Sent]:
    """Write a batch to the farm's shared storage, and start it.

    Parameters
    ----------
    manager : Manager
    title : str
    bakes : sequence of BatchBake
        From `folder.bakes_to_send`.
    shared : Path or None
        The folder that all machines share, as it is called here; by default, as the manager says.
    program : str
        What starts `rsibr` on a worker: words as a shell takes them, with variables of Flamenco.

    Raises
    ------
    FarmError, NotNowError
        The manager refuses, or does not answer.
    OutputFileError
        Shared storage cannot be written.
    InputFileError, SceneError
        See `folder.write_inputs`.
    """
    yield Progress(0, 1, f"asking {manager.url}")
    etag = manager.etag()
    root = shared or manager.shared_storage()
    if not root.is_dir():
        raise OutputFileError(
            f"The farm's shared storage {root} is no folder here: mount it, or give its path by --shared."
        )
    folder, name = root.absolute() / folder_name(title, bakes), batch_name(title)
    with made_folders(folder / INPUTS, folder / MAPS):
        placed = yield from write_inputs(folder / INPUTS, name, bakes)
    settings = {
        "folder": str(folder),
        "batch": name,
        "parts": " ".join(parts_of(placed)),
        "program": program,
    }
    number = manager.submit(title, settings, etag)
    maps = folder / MAPS
    made = [replace(bake, job=replace(bake.job, output=str(maps / bake.job.output))) for bake in placed]
    return Sent(number, name, manager.page(number), maps, made)


def bake_on_farm(
    manager: Manager,
    title: str,
    bakes: Sequence[BatchBake],
    folder: Path,
    shared: Path | None,
    program: str,
) -> Steps[tuple[Sent, dict[str, Failure]]]:
    """Send a batch, wait for its end, and fetch what it has made. Closed before, the job is cancelled.

    Parameters
    ----------
    folder : Path
        See `fetch`; for the others, see `send`.

    Returns
    -------
    sent : Sent
    failures : dict of str to Failure
        By output on shared storage.

    Raises
    ------
    FarmError, NotNowError, OutputFileError, InputFileError, SceneError
        See `send` and `fetch`.
    """
    sent = yield from send(manager, title, bakes, shared, program)
    status = yield from watch(manager, sent)
    yield from fetch(sent, folder)
    return sent, outcome(manager, sent, status)


def watch(manager: Manager, sent: Sent) -> Steps[str]:
    """Wait for the end of a job. If this is closed before, the job is cancelled.

    Parameters
    ----------
    manager : Manager
    sent : Sent

    Returns
    -------
    str
        The last status, in Flamenco's words; "failed" also where no task that is left can run.
    """
    told, ended, looked = Progress(0, 1, "waiting for a worker"), False, -LOOK_SECONDS
    try:
        while True:
            if time.monotonic() - looked >= LOOK_SECONDS:
                looked = time.monotonic()
                try:
                    status, tasks = manager.status(sent.number), manager.tasks(sent.number)
                except NotNowError as error:
                    told = replace(told, what=str(error))
                else:
                    ended = status in ENDS or _is_stuck(tasks)
                    if ended:
                        return status if status in ENDS else "failed"
                    told = _progress(tasks)
            yield told
            time.sleep(STEP_SECONDS)
    finally:
        if not ended:
            with suppress(FarmError, NotNowError):
                manager.cancel(sent.number)


def outcome(manager: Manager, sent: Sent, status: str) -> dict[str, Failure]:
    """Why bakes of a job that has ended failed, by output.

    Parameters
    ----------
    manager : Manager
    sent : Sent
    status : str
        See `watch`.
    """
    failures = kept_result(sent.folder, sent.bakes).failures
    if status == "completed" or not failures:
        return failures
    if status == "canceled":
        reason = "The farm's job was cancelled: send it again."
    else:
        reason = f"The farm's job failed ({_last_words(manager, sent)}): see {sent.page}."
    unknown = Failure(error=reason, try_again=True)
    return {output: unknown if known is UNKNOWN else known for output, known in failures.items()}


def fetch(sent: Sent, folder: Path) -> Steps[None]:
    """Copy what a job has made: map sets, unless whole ones are there, and of several page and summary.

    Parameters
    ----------
    sent : Sent
    folder : Path
        From `folder.bakes_to_send`.

    Raises
    ------
    OutputFileError
        A folder cannot be made here, or a file not be written.

    Warns
    -----
    RsibrWarning
        A map set that is there already was made with other settings.
    """
    made = [bake for bake in sent.bakes if Path(bake.job.output).is_file()]
    for done, bake in enumerate(made):
        path = Path(bake.job.output)
        yield Progress(done, len(made), f"fetching {path.name}")
        target = folder / path.relative_to(sent.maps)
        damaged = _is_damaged(target)
        if target.exists() and not damaged:
            _warn_unless_same(bake, target)
        else:
            _copy(path, target, damaged)
    if len(sent.bakes) > 1:
        for told in filter(Path.is_file, (sent.folder / "index.html", sent.folder / SUMMARY)):
            _copy(told, folder / told.relative_to(sent.maps), force=True)


def _copy(path: Path, target: Path, force: bool) -> None:
    make_folder(target.parent)
    with written_aside(target, force) as aside:
        shutil.copyfile(path, aside)


def _is_damaged(there: Path) -> bool:
    """Whether a file is what is left of a map set; one of another name may be a picture of the artist's."""
    return there.is_file() and there.name.endswith(".rsibr.exr") and not is_whole_map_set(there)


def _warn_unless_same(bake: BatchBake, there: Path) -> None:
    made = Path(bake.job.output)
    if bake.job.settings.KIND == ObjectInputsSettings.KIND:
        if not cmp(made, there, shallow=False):
            warn(f"{there} exists, and holds something else than {made}: remove it to have that.")
        return
    try:
        check_made_by(there, read_map_set_header(made)["recipe"])
    except OutputFileError as error:
        warn(str(error))


def _progress(tasks: Sequence[FarmTask]) -> Progress:
    done = sum(task["status"] == "completed" for task in tasks)
    active = [task["name"] for task in tasks if task["status"] == "active"]
    return Progress(done, len(tasks), f"baking {', '.join(active)}" if active else "waiting for a worker")


def _is_stuck(tasks: Sequence[FarmTask]) -> bool:
    """Whether a task has failed for good, and only the last is left, which waits for it."""
    return any(task["status"] == "failed" for task in tasks) and all(
        task["status"] in ENDS for task in tasks if task["name"] != LAST_TASK
    )


def _last_words(manager: Manager, sent: Sent) -> str:
    """The last line that a failed task wrote."""
    failed = [task for task in manager.tasks(sent.number) if task["status"] == "failed"]
    lines = manager.log(failed[0]["id"]).strip().splitlines() if failed else []
    return lines[-1] if lines else "no task says why"
