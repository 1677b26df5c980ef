"""Files appear under their names whole or not at all."""

import contextlib
import errno
import os
import secrets
from collections.abc import Iterator
from pathlib import Path

from ..core.errors import OutputFileError


def check_target(path: str | Path, force: bool = False) -> None:
    """Refuse a name that cannot or must not be written, before long work begins.

    Parameters
    ----------
    path : str or Path
        The file that will be written.
    force : bool
        Whether a file of that name may be replaced.

    Raises
    ------
    OutputFileError
        `path` is a folder or a device, or exists and is not to be replaced; or its folder is
        missing or cannot be written to.
    """
    path = Path(path)
    folder = path.resolve().parent
    if path.is_dir():
        raise OutputFileError(f"{path} is a folder: give the name of a file in it.")
    if path.exists() and not path.is_file():
        raise OutputFileError(f"{path} is a device, not a file: give another name.")
    if path.exists() and not force:
        raise OutputFileError(f"{path} exists: give another name, or --force to replace it.")
    if not folder.is_dir():
        raise OutputFileError(f"{folder} is not there to write {path.name} into: make that folder first.")
    if not os.access(folder, os.W_OK | os.X_OK):
        raise OutputFileError(f"{folder} cannot be written to: change its permissions, or write elsewhere.")


@contextlib.contextmanager
def written_aside(path: str | Path, force: bool = False) -> Iterator[Path]:
    """Write a file under a temporary name, then give it its own.

    Parameters
    ----------
    path : str or Path
        The final name; a link is followed, so that what it points to is replaced.
    force : bool
        Whether a file of that name may be replaced.

    Yields
    ------
    Path
        Where the body writes: a name of its own in the same folder, with the suffix of `path`. After
        the body it is synced and renamed; when anything is raised, it is removed.

    Raises
    ------
    OutputFileError
        As `check_target`, before the body and again before renaming; the disk is full; the body
        wrote nothing, or the system refuses a step.
    """
    check_target(path, force)
    target = Path(path).resolve()
    aside = target.with_name(f".{target.stem}.{secrets.token_hex(4)}{target.suffix}")
    try:
        yield aside
        _sync(aside)
        check_target(path, force)
        aside.replace(target)
        _sync_folder(target.parent)
    except OSError as error:
        # What the body could not read is for the body's own errors to tell
        if error.filename is not None and str(error.filename) not in (str(aside), str(target)):
            raise
        raise OutputFileError(_sentence(Path(path), error)) from error
    finally:
        with contextlib.suppress(OSError):
            aside.unlink()


def _sentence(path: Path, error: OSError) -> str:
    if error.errno in (errno.ENOSPC, errno.EDQUOT):
        return f"{path} was not written because the disk is full: free some space, or write elsewhere."
    return f"{path} was not written ({error.strerror}): check its folder, or write elsewhere."


def _sync(path: Path) -> None:
    """Have the disk hold the file before its name does: a crash then leaves the old file or the new."""
    descriptor = os.open(path, os.O_RDWR)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def _sync_folder(folder: Path) -> None:
    """Have the disk hold the new name too, where the system can; the file is whole either way."""
    with contextlib.suppress(OSError):
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)
