"""How operators tell of errors and warnings."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Protocol

import bpy

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


def can_start(operator: type[bpy.types.Operator], check: Callable[[], object]) -> bool:
    """Whether a check raises none of our errors; if it does, the button's tooltip says why."""
    try:
        check()
    except RsibrError as error:
        operator.poll_message_set(str(error))
        return False
    return True
