"""How many threads numerical work may use. Its results do not depend on their number."""

import os
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from typing import TypeVar

from .errors import RangeError

Item = TypeVar("Item")
Result = TypeVar("Result")

VARIABLE = "RSIBR_THREADS"
"""The environment variable that limits threads, here and in the processes that are started from here."""


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
        The variable holds no number of at least 1.
    """
    if limited():
        said = os.environ[VARIABLE]
        if not said.isdecimal() or int(said) < 1:
            raise RangeError(f'{VARIABLE} says "{said}": set it to a number of threads from 1, or unset it.')
        return int(said)
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


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
    MemoryError
        There is no memory for a thread.
    """
    count = thread_count()
    if count == 1:
        yield from map(function, items)
        return
    ahead: deque[Future[Result]] = deque()
    with ThreadPoolExecutor(count) as threads:
        for item in items:
            try:
                ahead.append(threads.submit(function, item))
            except RuntimeError as error:
                raise MemoryError(str(error)) from error
            if len(ahead) > 2 * count:
                yield ahead.popleft().result()
        while ahead:
            yield ahead.popleft().result()
