"""Silence for libraries that print: one sentence of ours tells what is wrong with a file."""

import contextlib
import io
import os
import threading
from collections.abc import Iterator

_bent = threading.Lock()


@contextlib.contextmanager
def unheard() -> Iterator[None]:
    """Within, output that a library prints is dropped.

    OpenEXR prints to Python's stdout, where a command's result belongs, and a line for every damaged chunk
    to the process's stderr; so does libpng. One thread at a time may bend those.
    """
    with _bent, contextlib.redirect_stdout(io.StringIO()), open(os.devnull, "wb") as nowhere:
        kept = os.dup(2)
        os.dup2(nowhere.fileno(), 2)
        try:
            yield
        finally:
            os.dup2(kept, 2)
            os.close(kept)
