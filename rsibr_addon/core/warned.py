"""Our warnings: told through Python's, or kept for whoever listens, such as an operator for its report."""

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar

from .errors import RsibrWarning

_listening: ContextVar[list[str] | None] = ContextVar("_listening", default=None)


def warn(sentence: str) -> None:
    """Warn of something with an `RsibrWarning`, or where it is recorded, without one."""
    kept = _listening.get()
    if kept is None:
        warnings.warn(sentence, RsibrWarning, stacklevel=2)
    else:
        kept.append(sentence)


def is_recorded() -> bool:
    """Whether somebody listens to the warnings of this thread."""
    return _listening.get() is not None


@contextmanager
def recorded_warnings() -> Iterator[list[str]]:
    """Within, the warnings of this thread are kept in the list, and other threads' are not."""
    sentences: list[str] = []
    token = _listening.set(sentences)
    try:
        yield sentences
    finally:
        _listening.reset(token)
