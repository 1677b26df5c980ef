"""Folders that one process holds at a time; a process that ends in any way releases them."""

import contextlib
import errno
import os
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import IO

LOCK = "rsibr.lock"
"""Name of the file in a held folder that marks it as one of ours."""

TRIES = 100
"""Most tries to hold a folder, which its former holder may be removing each time."""

_own: set[Path] = set()
"""Folders that this process holds alone."""


@contextlib.contextmanager
def held(folder: Path) -> Iterator[bool]:
    """Hold a folder alone; it is removed afterwards if it is empty.

    Parameters
    ----------
    folder : Path
        Made, for this user alone, if it does not exist.

    Yields
    ------
    bool
        False where the file system has no locks: another process may then hold the folder too.

    Raises
    ------
    BlockingIOError
        Another process holds it.
    OSError
        It cannot be made.
    """
    file, alone = _held(folder)
    if alone:
        _own.add(folder)
    try:
        yield alone
    finally:
        _own.discard(folder)
        with contextlib.suppress(OSError), file:
            if alone and os.listdir(folder) == [LOCK]:
                _close_and_remove(file, folder / LOCK)
                folder.rmdir()


def remove_empty_own() -> None:
    """Remove the empty folders that this process holds, as it ends without leaving their contexts."""
    for folder in list(_own):
        with contextlib.suppress(OSError):
            if os.listdir(folder) == [LOCK]:
                (folder / LOCK).unlink()
                folder.rmdir()


def _held(folder: Path) -> tuple[IO[str], bool]:
    """The open lock, and whether the system did lock it."""
    for _ in range(TRIES):
        file = _opened(folder)
        try:
            alone = _lock(file)
        except BlockingIOError:
            file.close()
            raise
        # The former holder may have removed it meanwhile
        if not alone or _is_there(folder / LOCK, file):
            return file, alone
        file.close()
    raise _never_there(folder)


def _opened(folder: Path) -> IO[str]:
    for _ in range(TRIES):
        folder.mkdir(mode=0o700, exist_ok=True)
        with contextlib.suppress(FileNotFoundError):
            return (folder / LOCK).open("a")
    raise _never_there(folder)


def _never_there(folder: Path) -> OSError:
    return OSError(errno.EIO, "the file system does not show what was made", str(folder / LOCK))


def _is_there(path: Path, file: IO[str]) -> bool:
    try:
        return os.path.samestat(os.fstat(file.fileno()), path.stat())
    except FileNotFoundError:
        return False


if sys.platform == "win32":
    import msvcrt

    def _lock(file: IO[str]) -> bool:
        try:
            msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
        except PermissionError as error:
            raise BlockingIOError(errno.EWOULDBLOCK, "held by another process") from error
        return True

    def _close_and_remove(file: IO[str], path: Path) -> None:
        """Close the lock first: an open file cannot be removed, least of all by another process."""
        file.close()
        path.unlink()
else:
    import fcntl

    def _lock(file: IO[str]) -> bool:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise
        except OSError:
            return False
        return True

    def _close_and_remove(file: IO[str], path: Path) -> None:
        """Remove the lock first: once it is closed, another process may hold it."""
        path.unlink()
        file.close()
