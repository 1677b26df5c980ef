"""A folder for finished parts of long work, so that work can continue after an interruption."""

import contextlib
import hashlib
import json
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from ..core.errors import OutputFileError, SchemaError
from ..core.schema import loads
from ..core.warned import warn
from .atomic import check_name, written_aside
from .locks import LOCK, held
from .staging import clear_strays

WORK = "job.json"


def work_folder_beside(output: Path) -> Path:
    """The folder for parts of a file: NAME.partial, or something shorter where that is too long a name."""
    path = output.resolve().with_name(f"{output.name}.partial")
    try:
        check_name(path)
    except OutputFileError:
        return path.with_name(f"{hashlib.sha256(os.fsencode(output.name)).hexdigest()[:16]}.partial")
    return path


@contextlib.contextmanager
def work_folder(path: Path, work: dict[str, Any]) -> Iterator[Path]:
    """Keep parts of `work` in its own folder until all is done.

    Parameters
    ----------
    path : Path
        Made if it does not exist. It is removed after the body, unless the body raises and has left files in
        it.
    work : dict
        JSON values that identify the work. Parts of the same work are kept; parts of other work are removed
        before the body.

    Yields
    ------
    Path
        `path`, for the body's files. No other process can hold it at the same time, even after this one was
        killed.

    Raises
    ------
    OutputFileError
        Another process has the folder, or it cannot be made; or a folder of that name holds files, but
        no work of ours.

    Warns
    -----
    RsibrWarning
        Parts of other work were removed.
    """
    _make(path)
    with _alone(path):
        _prepare(path, work)
        try:
            yield path
        except BaseException:
            if not _parts(path):
                (path / WORK).unlink(missing_ok=True)
            raise
        _empty(path)


def clear_work_folder(path: Path) -> None:
    """Remove the folder that a killed process left of work that it had just finished.

    Parameters
    ----------
    path : Path
        See `work_folder`.

    Raises
    ------
    OutputFileError
        As `work_folder`.
    """
    _make(path)
    with _alone(path):
        _empty(path)


def _make(path: Path) -> None:
    if path.is_dir() and not (path / LOCK).exists() and any(path.iterdir()):
        raise OutputFileError(f"{path} holds files other than unfinished work: move it, or write elsewhere.")
    try:
        path.mkdir(exist_ok=True)
    except OSError as error:
        raise OutputFileError(f"{path} cannot be made ({error.strerror}): write elsewhere.") from error


@contextlib.contextmanager
def _alone(path: Path) -> Iterator[None]:
    with contextlib.ExitStack() as stack:
        try:
            stack.enter_context(held(path))
        except BlockingIOError as error:
            raise OutputFileError(f"Another process is working in {path}: wait for it, or end it.") from error
        yield


def _prepare(path: Path, work: dict[str, Any]) -> None:
    clear_strays(path)
    if _read_work(path / WORK) == work:
        return
    if _parts(path):
        warn(f"{path} held parts of another job (or of another version), so this one starts afresh.")
    _empty(path)
    with written_aside(path / WORK) as aside:
        aside.write_text(json.dumps(work))


def _empty(path: Path) -> None:
    """Remove all but the lock, the description first: without it the rest counts as other work."""
    (path / WORK).unlink(missing_ok=True)
    for part in _parts(path):
        part.unlink()


def _parts(path: Path) -> list[Path]:
    return [item for item in path.iterdir() if item.name not in (WORK, LOCK)]


def _read_work(path: Path) -> Any:
    try:
        return loads(path.read_bytes())
    except (OSError, SchemaError):
        return None
