"""A folder for finished parts of long work, so that it can go on after an interruption."""

import contextlib
import json
import shutil
import sys
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import IO, Any

from ..core.errors import OutputFileError, RsibrWarning, SchemaError
from ..core.schema import loads
from .atomic import written_aside

WORK = "job.json"
LOCK = "lock"


@contextlib.contextmanager
def work_folder(path: Path, work: dict[str, Any]) -> Iterator[Path]:
    """Keep parts of `work` in a folder of its own until all is done.

    Parameters
    ----------
    path : Path
        Made if it is not there; removed after the body, but kept when the body raises and has left
        something there.
    work : dict
        JSON values that say what is done. What the folder holds of the same work stays; what it holds of
        other work is removed before the body.

    Yields
    ------
    Path
        `path`, for the body's files. No other process can have it at the same time, also after this
        one was killed.

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
    keep = True
    try:
        with _locked(path):
            _prepare(path, work)
            try:
                yield path
                keep = False
            except BaseException:
                keep = bool(_parts(path))
                raise
    finally:
        if not keep:
            shutil.rmtree(path)


def _make(path: Path) -> None:
    if path.is_dir() and any(path.iterdir()) and not (path / LOCK).exists():
        raise OutputFileError(f"{path} holds something else than our work: move it, or write elsewhere.")
    try:
        path.mkdir(exist_ok=True)
    except OSError as error:
        raise OutputFileError(f"{path} cannot be made ({error.strerror}): write elsewhere.") from error


def _prepare(path: Path, work: dict[str, Any]) -> None:
    if _read_work(path / WORK) == work:
        return
    parts = _parts(path)
    if parts:
        warnings.warn(
            f"{path} held parts of another job (or of another version), so this one starts afresh.",
            RsibrWarning,
            stacklevel=2,
        )
    # The description goes first: without it, whatever remains after a crash counts as other work.
    (path / WORK).unlink(missing_ok=True)
    for part in parts:
        part.unlink()
    with written_aside(path / WORK) as aside:
        aside.write_text(json.dumps(work))


def _parts(path: Path) -> list[Path]:
    return [item for item in path.iterdir() if item.name not in (WORK, LOCK)]


def _read_work(path: Path) -> Any:
    try:
        return loads(path.read_bytes())
    except (OSError, SchemaError):
        return None


@contextlib.contextmanager
def _locked(path: Path) -> Iterator[None]:
    """Hold the folder's lock, which the system gives free when this process ends, however it ends."""
    with (path / LOCK).open("a") as file:
        try:
            _lock(file)
        except OSError as error:
            raise OutputFileError(f"Another process is working in {path}: wait for it, or end it.") from error
        yield


if sys.platform == "win32":
    import msvcrt

    def _lock(file: IO[str]) -> None:
        msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
else:
    import fcntl

    def _lock(file: IO[str]) -> None:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
