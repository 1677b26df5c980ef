"""Files appear under their names whole or not at all."""

import contextlib
import os
import stat
from collections.abc import Iterator
from pathlib import Path

from ..core.errors import OutputFileError
from .outputs import Output, not_written, outputs_now
from .staging import clear_old_strays, clear_strays, staging_name


def check_target(path: str | Path, force: bool = False, endings: tuple[str, ...] = ()) -> None:
    """Refuse a name that cannot or must not be written, before long work begins.

    Files that killed processes left in its folder are removed.

    Parameters
    ----------
    path : str or Path
        The file that will be written.
    force : bool
        Whether a file of that name may be replaced; a read-only one never is.
    endings : tuple of str
        Endings that a name may have, as ".exr"; any, where there are none.

    Raises
    ------
    OutputFileError
        The name has another ending, or no file can have it; `path` is a folder or a device, or exists and
        must not be replaced; or its folder is missing or cannot be written to.
    """
    path = Path(path)
    if endings and not path.name.lower().endswith(endings):
        raise OutputFileError(f"{path} does not end in {' or '.join(endings)}: give a name that does.")
    check_name(path)
    if path.is_dir():
        raise OutputFileError(f"{path} is a folder: give the name of a file in it.")
    if path.exists() and not path.is_file():
        raise OutputFileError(f"{path} is a device, not a file: give another name.")
    if path.exists() and not force:
        raise OutputFileError(f"{path} exists: give another name, or --force to replace it.")
    if path.exists() and is_read_only(path):
        raise OutputFileError(f"{path} is read-only: change its permissions, or give another name.")


def check_name(path: Path) -> None:
    """Refuse a name that no file or folder can have, and a folder around it that cannot be written to.

    What processes that were killed left in that folder is removed.

    Raises
    ------
    OutputFileError
    """
    try:
        _look_at(path)  # first, as to resolve a loop of links is no OSError before Python 3.13
        str(path.resolve()).encode()
        _look_at(path.resolve().with_name(staging_name()) / ("a" + path.suffix))
    except ValueError as error:
        raise OutputFileError(
            f"{str(path)!a} cannot be a file's name: give one of letters in UTF-8."
        ) from error
    except OSError as error:
        raise OutputFileError(
            f"{path} cannot be a file's name ({error.strerror}): give another name."
        ) from error
    folder = path.resolve().parent
    try:
        is_folder = stat.S_ISDIR(folder.stat().st_mode)
    except PermissionError:
        is_folder = True  # perhaps: it cannot be written to in any case
    except (FileNotFoundError, NotADirectoryError) as error:
        raise OutputFileError(
            f"{folder} does not exist, so {path.name} cannot be written: make that folder first."
        ) from error
    if not is_folder:
        raise OutputFileError(f"{folder} is a file, so {path.name} cannot be in it: give another folder.")
    if not os.access(folder, os.W_OK | os.X_OK):
        raise OutputFileError(f"{folder} cannot be written to: change its permissions, or write elsewhere.")
    clear_strays(folder)
    clear_old_strays(path.resolve())


def _look_at(path: Path) -> None:
    """Raise what the system has against a name."""
    with contextlib.suppress(FileNotFoundError, NotADirectoryError, PermissionError):
        path.stat()


def is_read_only(path: Path) -> bool:
    """Whether a file may not be written, by anyone or by this user."""
    anyone = stat.S_IWUSR | stat.S_IWGRP | stat.S_IWOTH
    return not path.stat().st_mode & anyone or not os.access(path, os.W_OK)


@contextlib.contextmanager
def written_aside(path: str | Path, force: bool = False) -> Iterator[Path]:
    """Write a file under a temporary name, then give it its own.

    Parameters
    ----------
    path : str or Path
        The final name. A link is followed: it stays, and its target is replaced.
    force : bool
        Whether a file of that name may be replaced. Its mode is kept, and its owner and group as far as
        the system lets this user give files away.

    Yields
    ------
    Path
        The file that the body writes: a short name with the suffix of `path`, in a folder beside it. After
        the body it is synced and renamed, within `together` when that ends; when anything is raised, it is
        removed.

    Raises
    ------
    OutputFileError
        As `check_target`, before the body and again before renaming; the disk is full; the body
        wrote nothing, or the system refuses a step.
    """
    path = Path(path)
    check_target(path, force)
    with outputs_now() as outputs:
        aside = None
        try:
            aside = outputs.folder_beside(path) / f"a{path.suffix}"
            yield aside
            sync(aside)
        except OSError as error:
            # The body reports its own errors of reading
            if aside is not None and error.filename is not None and str(error.filename) != str(aside):
                raise
            raise not_written(path, error) from error
        outputs.add(Output(path, aside, lambda: check_target(path, force)))


def write_changed(path: Path, text: str) -> None:
    """Write a text, unless the file holds just that: what is up to date needs no disk that can be written.

    Parameters
    ----------
    path : Path
        Replaced if it exists.
    text : str
        Written as UTF-8; of names that are none, what cannot be written becomes "?".

    Raises
    ------
    OutputFileError
        See `written_aside`.
    """
    data = text.encode("utf-8", "replace")
    with contextlib.suppress(OSError):
        if path.read_bytes() == data:
            return
    with written_aside(path, force=True) as aside:
        aside.write_bytes(data)


def sync(path: Path) -> None:
    """Write the file to disk before it gets its name: a crash then leaves the old file or the new one."""
    descriptor = os.open(path, os.O_RDWR)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
