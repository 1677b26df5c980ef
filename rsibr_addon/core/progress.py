"""Progress of long work.

Long work is a generator that yields `Progress` and returns its result. The caller decides how to run it: a
command drains it and draws a bar, a modal operator takes one step per timer event.
"""

from collections.abc import Generator
from dataclasses import dataclass
from typing import TypeVar

Result = TypeVar("Result")


@dataclass(frozen=True)
class Progress:
    """`done` of `total` equal steps are finished; `what` names the next step."""

    done: int
    total: int
    what: str


Steps = Generator[Progress, None, Result]
"""A generator of `Progress` whose return value is the result of the work."""


def drain(steps: Steps[Result]) -> Result:
    """Run `steps` to its end and return its result."""
    while True:
        try:
            next(steps)
        except StopIteration as end:
            result: Result = end.value
            return result
