"""How many threads numerical work may use. Results depend on their number in their last bits at most."""

import errno
import os
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, TypeVar

from .errors import RangeError

if TYPE_CHECKING:
    from concurrent.futures import Future

Item = TypeVar("Item")
Result = TypeVar("Result")

VARIABLE = "RSIBR_THREADS"
"""The environment variable that limits threads, here and in the processes that are started from here."""

MOST = 1024
"""Greatest number of threads that one may ask for."""


def limited() -> bool:
    """Whether the environment's `VARIABLE` limits threads."""
    return VARIABLE in os.environ


def thread_count() -> int:
    """Threads that numerical work may use.

    Returns
    -------
    int
        What the environment's `VARIABLE` says; without it the number of processors that this process may run
        on.

    Raises
    ------
    RangeError
        The variable holds no number from 1 to `MOST`.
    """
    if limited():
        said = os.environ[VARIABLE]
        if not (said.isdecimal() and len(said) <= len(str(MOST)) and 1 <= int(said) <= MOST):
            raise RangeError(
                f'{VARIABLE} says "{said}": set it to a number of threads from 1 to {MOST}, or unset it.'
            )
        return int(said)
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


@contextmanager
def starting() -> Iterator[None]:
    """Within, a compiled library may start as many threads as `thread_count` says.

    Raises
    ------
    RangeError
        The system starts no more threads.
    """
    try:
        yield
    except RuntimeError as error:  # as C++ tells it
        if os.strerror(errno.EAGAIN) not in str(error):
            raise
        raise _too_many() from error


def _too_many() -> RangeError:
    return RangeError(
        f"The system starts no {thread_count()} threads, as where memory or addresses are limited: ask for "
        f"fewer by --threads or {VARIABLE}."
    )


def in_order(function: Callable[[Item], Result], items: Iterable[Item]) -> Iterator[Result]:
    """Results of a function, computed on several threads and given in the order of the items.

    Parameters
    ----------
    function : callable
        May be called on several threads at once; pays where numpy or another library works long in each call.
    items : iterable

    Yields
    ------
    Result
        Of every item in turn. Few are computed ahead of it, so that their memory is bounded.

    Raises
    ------
    RangeError
        The system starts no more threads.
    """
    count = thread_count()
    if count == 1:
        yield from map(function, items)
        return
    # Takes 0.01 s to import, and few commands need it
    from concurrent.futures import ThreadPoolExecutor

    ahead: deque[Future[Result]] = deque()
    with ThreadPoolExecutor(count) as threads:
        for item in items:
            try:
                ahead.append(threads.submit(function, item))
            except RuntimeError as error:
                raise _too_many() from error
            if len(ahead) > 2 * count:
                yield ahead.popleft().result()
        while ahead:
            yield ahead.popleft().result()
