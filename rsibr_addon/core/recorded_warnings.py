"""Our warnings, kept to be told in another place than Python's."""

import threading
import warnings
from collections.abc import Iterator
from contextlib import contextmanager

from .errors import RsibrWarning

_recording = threading.RLock()
"""Python records the warnings of all threads at once, and so only one thread may do so."""


@contextmanager
def recorded_warnings() -> Iterator[list[str]]:
    """Within, our warnings are kept; once it has ended, the list holds their sentences."""
    sentences: list[str] = []
    with _recording, warnings.catch_warnings(record=True, action="always", category=RsibrWarning) as caught:
        yield sentences
    sentences += [str(warning.message) for warning in caught]
