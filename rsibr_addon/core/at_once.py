"""An executor without threads."""

from collections.abc import Callable
from concurrent.futures import Executor, Future
from typing import Any, TypeVar

Result = TypeVar("Result")


class AtOnce(Executor):
    """Does work when it is given, where nobody need be kept from waiting."""

    def submit(self, function: Callable[..., Result], /, *given: Any, **named: Any) -> Future[Result]:
        """Do it."""
        done = Future[Result]()
        try:
            done.set_result(function(*given, **named))
        except Exception as error:  # Raised where the result is asked for, as a thread's own would be
            done.set_exception(error)
        return done
