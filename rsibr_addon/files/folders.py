"""Folders of results appear under their names whole or not at all."""

import contextlib
import os
import secrets
import shutil
from collections.abc import Iterator
from pathlib import Path

from ..core.errors import OutputFileError


def check_folder_target(path: str | Path, marker: str, force: bool = False) -> None:
    """Refuse a folder that cannot or must not be written, before long work begins.

    Parameters
    ----------
    path : str or Path
        The folder that will be written.
    marker : str
        Name of a file that every such folder holds, by which an earlier result is known.
    force : bool
        Whether an earlier result may be replaced; any other folder never is.

    Raises
    ------
    OutputFileError
        `path` is a file, or exists and is not to be replaced; or the folder around it is missing or
        cannot be written to.
    """
    path = Path(path)
    around = path.resolve().parent
    if path.exists() and not path.is_dir():
        raise OutputFileError(f"{path} is a file: give the name of a folder.")
    if path.is_dir() and any(path.iterdir()):
        if not (path / marker).is_file():
            raise OutputFileError(f"{path} holds other things: give the name of a new folder.")
        if not force:
            raise OutputFileError(f"{path} exists: give another name, or --force to replace it.")
    if not around.is_dir():
        raise OutputFileError(f"{around} is not there to write {path.name} into: make that folder first.")
    if not os.access(around, os.W_OK | os.X_OK):
        raise OutputFileError(f"{around} cannot be written to: change its permissions, or write elsewhere.")


@contextlib.contextmanager
def folder_written_aside(path: str | Path, marker: str, force: bool = False) -> Iterator[Path]:
    """Fill a folder under a temporary name, then give it its own.

    Parameters
    ----------
    path, marker, force
        As in `check_folder_target`.

    Yields
    ------
    Path
        An empty folder beside `path`. After the body its files are synced and it is renamed; when
        anything is raised, it is removed.

    Raises
    ------
    OutputFileError
        As `check_folder_target`, or the system refuses a step.
    """
    check_folder_target(path, marker, force)
    target = Path(path).resolve()
    aside, replaced = (target.with_name(f".{target.name}.{secrets.token_hex(4)}") for _ in range(2))
    try:
        aside.mkdir()
        yield aside
        for file in aside.rglob("*"):
            if file.is_file():
                _sync(file)
        check_folder_target(path, marker, force)
        _swap(aside, target, replaced)
    except OSError as error:
        raise OutputFileError(
            f"{path} was not written ({error.strerror}): free some space, or write elsewhere."
        ) from error
    finally:
        for leftover in (aside, replaced):
            shutil.rmtree(leftover, ignore_errors=True)


def _swap(aside: Path, target: Path, replaced: Path) -> None:
    """Give `aside` the name `target`, and what had that name, if anything, the name `replaced`."""
    if not target.exists():
        aside.rename(target)
        return
    target.rename(replaced)
    try:
        aside.rename(target)
    except OSError:
        replaced.rename(target)
        raise


def _sync(path: Path) -> None:
    """Have the disk hold the file before its folder's name does."""
    with path.open("rb+") as file:
        os.fsync(file.fileno())
