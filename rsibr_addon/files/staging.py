"""Folders for unfinished outputs, beside their final place or among temporary files.

Their names are short, whatever the file's. A process that is killed leaves its folder; the next one of ours
that looks there removes folders that no living process holds.
"""

import contextlib
import errno
import os
import re
import shutil
import socket
import zlib
from collections.abc import Iterator
from pathlib import Path

from .locks import LOCK, TRIES, held, remove_empty_own

REPLACED = "replaced"
"""Folder in a staging folder, for the former owner of the final name."""

PARTIAL = ".partial"
"""Ending of work folders: see `work_folder`."""

STRANGE_SECONDS = 24 * 60 * 60.0
"""[s] Age from which a folder without a lock is removed: another machine's, on a shared disk, or an older
version's."""

_NAME = re.compile(r"\.rsibr-([0-9a-f]{8})-[0-9a-f]{8}")
_BLENDERS_NAME = re.compile(r"blender_\w{6}")

_own: set[Path] = set()


def staging_name() -> str:
    """A unique name for a staging folder, which tells its machine."""
    return f".rsibr-{_machine()}-{os.urandom(4).hex()}"


def is_staging_folder(path: Path) -> bool:
    """Whether a folder's name is that of a staging folder."""
    return _NAME.fullmatch(path.name) is not None


@contextlib.contextmanager
def staging_folder(around: Path) -> Iterator[Path]:
    """A new folder that this process holds, removed afterwards.

    Parameters
    ----------
    around : Path
        The folder in which it is made.

    Yields
    ------
    Path

    Raises
    ------
    OSError
        It cannot be made.
    """
    clear_strays(around)
    with contextlib.ExitStack() as stack:
        folder = _new_folder(around, stack)
        _own.add(folder)
        try:
            yield folder
        finally:
            _remove(folder)
            _own.discard(folder)


def _new_folder(around: Path, stack: contextlib.ExitStack) -> Path:
    """Make a folder, held as long as `stack` is open."""
    for _ in range(TRIES):
        folder = around / staging_name()
        # Before it is held, another process may take it for a stray
        with contextlib.suppress(BlockingIOError):
            stack.enter_context(held(folder))
            return folder
    raise BlockingIOError(errno.EWOULDBLOCK, "other processes hold each new folder", str(around))


def remove_own() -> None:
    """Remove the staging folders of this process, which is about to end without leaving their contexts.

    Work folders that it holds go too, where nothing in them is finished.
    """
    for folder in list(_own):
        _remove(folder)
    remove_empty_own()


def clear_strays(around: Path) -> None:
    """Remove staging folders, and Blender's temporary ones that we held, of processes that were killed.

    Empty work folders go too, but for those whose output is there: they tell that it is whole.

    Parameters
    ----------
    around : Path
        The folder in which they are; one that cannot be read is skipped.

    Notes
    -----
    A folder that a killed process had moved away to replace it first gets its name back.
    """
    with contextlib.suppress(OSError):
        entries = list(os.scandir(around))
        for entry in filter(_is_empty_work, entries):
            with contextlib.suppress(OSError), held(Path(entry)):
                pass  # it goes afterwards, as it is empty
        strays = [Path(entry) for entry in entries if _may_be_stray(entry)]
        for folder in strays:
            with contextlib.suppress(OSError), held(folder) as alone:
                if alone:
                    _remove(folder)


def clear_old_strays(output: Path) -> None:
    """Remove files that version 0.1.0, when killed, left beside an output: .NAME.HEX.SUFFIX, a day old.

    Parameters
    ----------
    output : Path
        Without links.
    """
    old = re.compile(rf"\.{re.escape(output.stem)}\.[0-9a-f]{{8}}{re.escape(output.suffix)}")
    with contextlib.suppress(OSError):
        for entry in os.scandir(output.parent):
            ours = old.fullmatch(entry.name) and entry.is_file(follow_symlinks=False)
            if ours and _age(entry) > STRANGE_SECONDS:
                os.unlink(entry)


def _is_empty_work(entry: os.DirEntry[str]) -> bool:
    # First what costs nothing: a folder may hold thousands of outputs
    if not entry.name.endswith(PARTIAL) or not entry.is_dir(follow_symlinks=False):
        return False
    if Path(entry).with_name(entry.name.removesuffix(PARTIAL)).exists():
        return False
    with contextlib.suppress(OSError):
        return os.listdir(entry) == [LOCK]
    return False


def _may_be_stray(entry: os.DirEntry[str]) -> bool:
    if not entry.is_dir(follow_symlinks=False):
        return False
    if _BLENDERS_NAME.fullmatch(entry.name):
        return (Path(entry) / LOCK).is_file()
    name = _NAME.fullmatch(entry.name)
    return name is not None and (name[1] == _machine() or _age(entry) > STRANGE_SECONDS)


def _age(entry: os.DirEntry[str]) -> float:
    """Seconds since a file or a folder was last written to, by the clock of its disk."""
    around = Path(entry).parent
    return around.stat().st_mtime - entry.stat().st_mtime


def _remove(folder: Path) -> None:
    with contextlib.suppress(OSError):
        _put_back(folder / REPLACED, folder.parent)
    shutil.rmtree(folder, ignore_errors=True)


def _put_back(replaced: Path, around: Path) -> None:
    if replaced.is_dir():
        for item in replaced.iterdir():
            if item.is_dir() and not os.path.lexists(around / item.name):
                item.rename(around / item.name)


def _machine() -> str:
    return f"{zlib.crc32(socket.gethostname().encode()):08x}"
