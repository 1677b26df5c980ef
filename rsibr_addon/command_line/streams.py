"""Where text goes out: what is ours to the streams of the process, what others say nowhere or to be read."""

import ctypes
import errno
import io
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout

CLEAR_LINE = "\r\x1b[2K"
"""Control sequence that clears a terminal's line and moves back to its begin."""

DEFAULT_COLUMNS = 80


class Outlet(io.TextIOBase):
    """Text to a file descriptor, which may be closed, broken or full: what cannot be written is dropped.

    On a terminal, control characters that come with names and other text are spelled out.

    Attributes
    ----------
    error : OSError or None
        Why something was dropped.
    """

    def __init__(self, descriptor: int) -> None:
        self._descriptor = descriptor
        self.error: OSError | None = None

    def write(self, text: str) -> int:
        """Write text, or drop it."""
        self._put("".join(map(_spelled_out, text)) if self.isatty() else text)
        return len(text)

    def control(self, sequence: str) -> None:
        """Write what moves the cursor of a terminal."""
        self._put(sequence)

    def isatty(self) -> bool:
        """Whether it is a terminal."""
        return os.isatty(self._descriptor)

    @property
    def columns(self) -> int:
        """Width of the terminal; `DEFAULT_COLUMNS` if it is none or does not say."""
        try:
            return os.get_terminal_size(self._descriptor).columns or DEFAULT_COLUMNS
        except OSError:
            return DEFAULT_COLUMNS

    def _put(self, text: str) -> None:
        # Names that are not UTF-8 are written as their bytes
        data = text.encode("utf-8", "surrogateescape")
        try:
            while data:
                data = data[os.write(self._descriptor, data) :]
        except OSError as error:
            self.error = error

    @property
    def full(self) -> bool:
        """Whether something was dropped that a reader may wait for."""
        return self.error is not None and self.error.errno not in (errno.EPIPE, errno.EBADF)


def _spelled_out(character: str) -> str:
    if character.isprintable() or character in "\n\t":
        return character
    return character.encode("unicode_escape").decode("ascii")


def open_closed_streams() -> None:
    """Give the process the standard streams that it was started without.

    A file opened later would else get the number of one, and what Blender prints would go into it.
    """
    descriptor = 0
    while descriptor <= 2:
        descriptor = os.open(os.devnull, os.O_RDWR)
    os.close(descriptor)


@contextmanager
def own_streams() -> Iterator[tuple[Outlet, Outlet]]:
    """Within, Python's standard output and error are an `Outlet` each."""
    for stream in (sys.stdout, sys.stderr):
        if stream is not None:  # as of a process without it
            stream.flush()
    kept = os.dup(1), os.dup(2)
    result, told = map(Outlet, kept)
    try:
        with redirect_stdout(result), redirect_stderr(told):
            yield result, told
    finally:
        for descriptor in kept:
            os.close(descriptor)


@contextmanager
def others_hushed(heard: Outlet | None, log: str) -> Iterator[None]:
    """Within, what others write to the standard streams is kept from them.

    Blender, its libraries and the graphics driver write beneath Python, to C's streams or to the file
    descriptors 1 and 2.

    Parameters
    ----------
    heard : Outlet or None
        Standard error, where it is to be heard after all.
    log : str
        The file to which it is added otherwise.

    Raises
    ------
    OSError
        The log cannot be opened.
    """
    with open(log, "a", encoding="utf-8", errors="surrogateescape", buffering=1) as file:
        kept = os.dup(1), os.dup(2)
        for descriptor in (1, 2):
            os.dup2(kept[1] if heard else file.fileno(), descriptor)
        try:
            with redirect_stdout(heard or file):
                yield
        finally:
            ctypes.CDLL("ucrtbase" if sys.platform == "win32" else None).fflush(None)
            for descriptor, before in enumerate(kept, start=1):
                os.dup2(before, descriptor)
                os.close(before)
