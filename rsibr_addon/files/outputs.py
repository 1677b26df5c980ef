"""Several outputs that appear together and whole, or not at all."""

import contextlib
import errno
import os
import shutil
import stat
import sys
from collections.abc import Callable, Iterator
from contextvars import ContextVar
from dataclasses import dataclass
from itertools import permutations
from pathlib import Path
from types import TracebackType
from typing import Self

from ..core.errors import NotNowError, OutputFileError
from .staging import REPLACED, staging_folder

FULL = frozenset({errno.ENOSPC, errno.EDQUOT})
MAY_PASS = FULL | {
    getattr(errno, name)
    for name in ("EIO", "EAGAIN", "EBUSY", "EMFILE", "ENFILE", "ENOMEM", "ESTALE", "ETIMEDOUT", "EHOSTDOWN")
    if hasattr(errno, name)
}
"""Numbers of the system's errors that another try may not meet."""


@dataclass(frozen=True)
class Output:
    """A file or a folder that has been written aside.

    Attributes
    ----------
    path : Path
        Its final name as the user gave it; a link is followed.
    aside : Path
        Its present place, in a staging folder beside `target`.
    check : callable
        Raises OutputFileError if it must not be written.
    """

    path: Path
    aside: Path
    check: Callable[[], None]

    @property
    def target(self) -> Path:
        """Its final place: a link is followed."""
        return self.path.resolve()

    @property
    def replaced(self) -> Path:
        """Place in which the former owner of its name is kept until all is done."""
        return self.aside.parent / REPLACED / self.target.name


class Outputs:
    """A context whose outputs get their names when it ends without an exception; else they are removed."""

    def __init__(self) -> None:
        self._staging = contextlib.ExitStack()
        self._written: list[Output] = []

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        with self._staging:
            if kind is None:
                _appear(self._written)

    def folder_beside(self, path: Path) -> Path:
        """An empty folder for the future `path`, on the same disk.

        Raises
        ------
        OSError
        """
        return self._staging.enter_context(staging_folder(path.resolve().parent))

    def add(self, output: Output) -> None:
        """Note an output that is written and synced."""
        self._written.append(output)


_together: ContextVar[Outputs | None] = ContextVar("together", default=None)


@contextlib.contextmanager
def together() -> Iterator[None]:
    """Make all outputs of the body appear when it ends, or none when anything is raised.

    The body writes by `written_aside` and `folder_written_aside`, and does not yield: outputs that others
    write between its steps would be taken for its own.

    Raises
    ------
    OutputFileError
        An output must not be written, or the system refuses a step; everything is then as before.
    """
    with Outputs() as outputs:
        token = _together.set(outputs)
        try:
            yield
        finally:
            _together.reset(token)


def outputs_now() -> contextlib.AbstractContextManager[Outputs]:
    """The outputs to which a new one belongs: those of `together`, or its own."""
    outer = _together.get()
    return Outputs() if outer is None else contextlib.nullcontext(outer)


def not_written(path: Path, error: OSError, done: str = "written") -> OutputFileError:
    """The error to raise when the system refuses to write `path`; done: what was not done to it."""
    if error.errno in FULL:
        return NotNowError(
            f"{path} was not {done} because the disk is full: free some space, or write elsewhere."
        )
    kind = NotNowError if error.errno in MAY_PASS else OutputFileError
    return kind(f"{path} was not {done} ({error.strerror}): check its folder, or write elsewhere.")


def make_folder(folder: Path) -> None:
    """Make a folder for outputs, and those around it, unless it is there.

    Raises
    ------
    OutputFileError
        The system refuses; a NotNowError, where another try may help.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise not_written(folder, error, "made") from error


@contextlib.contextmanager
def made_folders(*folders: Path) -> Iterator[None]:
    """Make folders for outputs; those made that are still empty when anything is raised are removed.

    Raises
    ------
    OutputFileError
        See `make_folder`.
    """
    missing = [each for folder in folders for each in (folder, *folder.parents) if not each.exists()]
    try:
        for folder in folders:
            make_folder(folder)
        yield
    except BaseException:
        for each in sorted(set(missing), reverse=True):
            with contextlib.suppress(OSError):
                each.rmdir()
        raise


def _appear(outputs: list[Output]) -> None:
    for output in outputs:
        output.check()
    _check_apart(outputs)
    done: list[Output] = []
    for output in outputs:
        try:
            _exchange(output, alone=len(outputs) == 1)
        except OSError as error:
            for each in reversed(done):
                _change_back(each)
            raise not_written(output.path, error) from error
        done.append(output)
    for folder in {output.target.parent for output in outputs}:
        _sync_folder(folder)


def _check_apart(outputs: list[Output]) -> None:
    """Refuse outputs of which one would replace the other, or the folder that it is in."""
    for first, second in permutations(outputs, 2):
        if second.target.is_relative_to(first.target):
            raise OutputFileError(
                f"{second.path} would be replaced by {first.path}: give the two names apart from each other."
            )


def _exchange(output: Output, alone: bool) -> None:
    """Give an output its name, with the mode and, as far as the system allows, the owner of what had it."""
    target, replaced = output.target, output.replaced
    if not target.exists():
        output.aside.rename(target)
        return
    _make_alike(output.aside, target.stat())
    if target.is_dir():
        replaced.parent.mkdir()
        target.rename(replaced)
        try:
            output.aside.rename(target)
        except OSError:
            replaced.rename(target)
            raise
        return
    if not alone:  # else there is nothing to undo
        replaced.parent.mkdir()
        _duplicate(target, replaced)
    output.aside.replace(target)


def _change_back(output: Output) -> None:
    """Undo `_exchange`."""
    target, replaced = output.target, output.replaced
    if replaced.is_file():
        replaced.replace(target)
        return
    target.rename(output.aside)
    if replaced.exists():
        replaced.rename(target)


def _make_alike(path: Path, status: os.stat_result) -> None:
    if sys.platform != "win32":
        for user, group in ((-1, status.st_gid), (status.st_uid, -1)):
            with contextlib.suppress(OSError):
                os.chown(path, user, group)
    path.chmod(stat.S_IMODE(status.st_mode))


def _duplicate(path: Path, other: Path) -> None:
    try:
        other.hardlink_to(path)
    except OSError:  # which not every file system knows
        shutil.copy2(path, other)


def _sync_folder(folder: Path) -> None:
    """Write the new names to disk too, where the system can; the files are whole either way."""
    with contextlib.suppress(OSError):
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)
