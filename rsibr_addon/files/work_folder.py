"""The folder beside an output of whoever makes it, with finished parts of long work.

It is held by one process at a time, and lets interrupted work go on.
"""

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
from .staging import PARTIAL, clear_strays

WORK = "job.json"


def work_folder_beside(output: Path) -> Path:
    """The folder for parts of a file: NAME.partial, or something shorter where that is too long a name."""
    path = output.resolve().with_name(f"{output.name}{PARTIAL}")
    try:
        check_name(path)
    except OutputFileError:
        return path.with_name(f"{hashlib.sha256(os.fsencode(output.name)).hexdigest()[:16]}{PARTIAL}")
    return path


@contextlib.contextmanager
def held_work_folder(path: Path) -> Iterator[None]:
    """Hold the folder of some work alone, even after this process was killed; then it is released.

    Parameters
    ----------
    path : Path
        Made if it does not exist. It is removed after the body, unless parts are left in it.

    Raises
    ------
    BlockingIOError
        Another process holds it.
    OutputFileError
        It cannot be made; or a folder of that name holds files, but no work of ours.
    """
    _make(path)
    with held(path):
        yield


@contextlib.contextmanager
def kept_parts(path: Path, work: dict[str, Any]) -> Iterator[None]:
    """Keep parts of `work` in its folder until all is done.

    Parameters
    ----------
    path : Path
        Of `held_work_folder`. It is emptied after the body, unless the body raises and has left files in it.
    work : dict
        JSON values that identify the work. Parts of the same work are kept; parts of other work are removed
        before the body.

    Warns
    -----
    RsibrWarning
        Parts of other work were removed.
    """
    _prepare(path, work)
    try:
        yield
    except BaseException:
        if not _parts(path):
            (path / WORK).unlink(missing_ok=True)
        raise
    clear_parts(path)


def clear_parts(path: Path) -> None:
    """Remove all parts from a folder of `held_work_folder`.

    The description goes first: without it the rest counts as other work.
    """
    (path / WORK).unlink(missing_ok=True)
    for part in _parts(path):
        part.unlink()


def _make(path: Path) -> None:
    try:
        path.mkdir(exist_ok=True)
        names = os.listdir(path)
    except FileNotFoundError:  # its former holder has just removed it
        return
    except OSError as error:
        raise OutputFileError(f"{path} cannot be made ({error.strerror}): write elsewhere.") from error
    if names and LOCK not in names:
        raise OutputFileError(f"{path} holds files other than unfinished work: move it, or write elsewhere.")


def _prepare(path: Path, work: dict[str, Any]) -> None:
    clear_strays(path)
    if _read_work(path / WORK) == work:
        return
    if _parts(path):
        warn(f"{path} held parts of another job (or of another version), so this one starts afresh.")
    clear_parts(path)
    with written_aside(path / WORK) as aside:
        aside.write_text(json.dumps(work))


def _parts(path: Path) -> list[Path]:
    return [item for item in path.iterdir() if item.name not in (WORK, LOCK)]


def _read_work(path: Path) -> Any:
    try:
        return loads(path.read_bytes())
    except (OSError, SchemaError):
        return None
