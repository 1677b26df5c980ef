"""How operators tell of errors and warnings."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Protocol

from ..rsibr_addon.core.errors import RsibrError
from ..rsibr_addon.core.warned import recorded_warnings


class Reporter(Protocol):
    """An operator of Blender's."""

    def report(self, type: set[str], message: str, /) -> None:
        """Tell a `message` to whoever called it; `type` is one of INFO, WARNING, ERROR."""


@contextmanager
def reporting(operator: Reporter) -> Iterator[None]:
    """Turn our errors, which end the block, and our warnings into an operator's reports."""
    with recorded_warnings() as warnings:
        try:
            yield
        except (RsibrError, OSError) as error:
            operator.report({"ERROR"}, str(error))
    for warning in warnings:
        operator.report({"WARNING"}, warning)
