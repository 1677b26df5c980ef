"""Fits that are kept, for a process that bakes the same materials in one environment after another."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any, TypeVar

from ..progress import Steps
from ..warned import recorded_warnings, warn

Made = TypeVar("Made")


@contextmanager
def fits_kept() -> Iterator[None]:
    """Within, what `kept_fit` makes is kept; a fit takes some 15 kB."""
    token = _kept.set({})
    try:
        yield
    finally:
        _kept.reset(token)


def kept_fit(key: str, make: Callable[[], Steps[Made]]) -> Steps[Made]:
    """Make a fit, unless one with the same key is kept, whose warnings are then told again.

    Parameters
    ----------
    key : str
        Equal for all that is made alike.
    make : callable
        What it raises is not kept.
    """
    kept = _kept.get()
    if kept is None:
        return (yield from make())
    if key not in kept:
        with recorded_warnings() as warnings:
            made = yield from make()
        kept[key] = made, warnings
    found, warnings = kept[key]
    for sentence in warnings:
        warn(sentence)
    return found  # type: ignore[no-any-return]  # made by an equal `make`


_kept: ContextVar[dict[str, tuple[Any, list[str]]] | None] = ContextVar("_kept", default=None)
