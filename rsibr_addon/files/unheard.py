"""Silence for libraries that print: one sentence of ours tells what is wrong with a file."""

import contextlib
import os
import sys
import threading
from collections.abc import Iterator
from typing import Any, TextIO

_bent = threading.Lock()


class _WithoutThread:
    """A stream that drops what one thread writes; everybody else's goes where it went before."""

    def __init__(self, stream: TextIO, thread: int) -> None:
        self._stream, self._thread = stream, thread

    def write(self, text: str) -> int:
        """Write, or drop."""
        return len(text) if threading.get_ident() == self._thread else self._stream.write(text)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)


@contextlib.contextmanager
def unheard() -> Iterator[None]:
    """Within, output that a library prints in this thread is dropped.

    OpenEXR prints to Python's stdout, where a command's result belongs, and a line for every damaged chunk
    to the process's stderr; so does libpng. All threads share that stderr, and others have their own to say
    there: it is bent for the main thread alone.
    """
    with _bent:
        # Only now: another thread's would drop what that thread prints later
        own: Any = _WithoutThread(sys.stdout, threading.get_ident())
        with contextlib.redirect_stdout(own):
            if threading.current_thread() is not threading.main_thread():
                yield
                return
            with open(os.devnull, "wb") as nowhere:
                kept = os.dup(2)
                os.dup2(nowhere.fileno(), 2)
                try:
                    yield
                finally:
                    os.dup2(kept, 2)
                    os.close(kept)
