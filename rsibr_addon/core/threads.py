"""How many threads numerical work may use. Its results do not depend on their number."""

import os

from .errors import RangeError

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
