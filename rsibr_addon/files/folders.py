"""Folders of results appear under their names whole or not at all."""

import contextlib
from collections.abc import Iterator
from pathlib import Path

from ..core.errors import OutputFileError
from .atomic import check_name, is_read_only, sync
from .outputs import Output, not_written, outputs_now


def check_folder_target(path: str | Path, marker: str, force: bool = False) -> None:
    """Refuse a folder that cannot or must not be written, before long work begins.

    What processes that were killed left in the folder around it is removed.

    Parameters
    ----------
    path : str or Path
        The folder that will be written.
    marker : str
        Name of a file that every such folder holds, and that marks an earlier result.
    force : bool
        Whether an earlier result may be replaced; any other folder never is.

    Raises
    ------
    OutputFileError
        No folder can have that name; `path` is a file, or exists and must not be replaced, or is read-only;
        or the folder around it is missing or cannot be written to.
    """
    path = Path(path)
    check_name(path)
    if path.exists() and not path.is_dir():
        raise OutputFileError(f"{path} is a file: give the name of a folder.")
    if path.is_dir() and any(path.iterdir()):
        if not (path / marker).is_file():
            raise OutputFileError(f"{path} holds other things: give the name of a new folder.")
        if not force:
            raise OutputFileError(f"{path} exists: give another name, or --force to replace it.")
    if path.is_dir() and is_read_only(path):
        raise OutputFileError(f"{path} is read-only: change its permissions, or give another name.")


@contextlib.contextmanager
def folder_written_aside(path: str | Path, marker: str, force: bool = False) -> Iterator[Path]:
    """Fill a folder under a temporary name, then give it its own.

    Parameters
    ----------
    path, marker, force
        As in `check_folder_target`. A replaced folder leaves its mode and owner, as in `written_aside`.

    Yields
    ------
    Path
        An empty folder, in one beside `path`. After the body its files are synced and it is renamed,
        within `together` when that ends; when anything is raised, it is removed.

    Raises
    ------
    OutputFileError
        As `check_folder_target`, or the system refuses a step.
    """
    path = Path(path)
    check_folder_target(path, marker, force)
    with outputs_now() as outputs:
        try:
            aside = outputs.folder_beside(path) / "a"
            aside.mkdir()
            yield aside
            for file in aside.rglob("*"):
                if file.is_file():
                    sync(file)
        except OSError as error:
            raise not_written(path, error) from error
        outputs.add(Output(path, aside, lambda: check_folder_target(path, marker, force)))
