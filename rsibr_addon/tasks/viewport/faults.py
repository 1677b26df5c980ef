"""What goes wrong with previews: each fault costs as little as can be, and is told once."""

import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from ...core.errors import RsibrError
from ...files.kinds.registry import look_types
from ...host.option_properties import said_by
from ...host.visible_surfaces import map_set_of


@dataclass(frozen=True)
class _Fault:
    """What went wrong with an object, and the settings that it went wrong with."""

    settings: object
    message: str


class Faults:
    """Faults of objects, which are left to Blender until their settings change; and what ends all previews.

    Attributes
    ----------
    trouble : str or None
        Why there are no previews at all, in a sentence.
    """

    def __init__(self) -> None:
        self.trouble: str | None = None
        self._of_items: dict[int, _Fault] = {}

    @contextmanager
    def guarded(self) -> Iterator[None]:
        """Within, whatever goes wrong ends all previews, and is told once: Blender goes on."""
        try:
            yield
        except Exception as error:
            self.trouble = self.trouble or _told(error)

    def note(self, item: Any, error: Exception) -> None:
        """Keep what went wrong with an object."""
        self._of_items[item.original.session_uid] = _Fault(settings_of(item), _told(error))

    def message(self, item: Any) -> str | None:
        """What went wrong with an object, in a sentence."""
        fault = self._of_items.get(item.original.session_uid)
        return fault.message if fault else None

    def stands(self, item: Any) -> bool:
        """Whether an object has a fault and its settings since; a fault of other settings is forgotten."""
        fault = self._of_items.get(item.original.session_uid)
        if fault and fault.settings != settings_of(item):
            del self._of_items[item.original.session_uid]
            return False
        return fault is not None

    def forget(self, item: Any) -> None:
        """Forget the fault of an object that is to have no preview."""
        self._of_items.pop(item.original.session_uid, None)

    def clear(self) -> None:
        """Forget the faults of all objects."""
        self._of_items.clear()


def settings_of(item: Any) -> object:
    """All that an object says of its preview.

    Parameters
    ----------
    item : bpy.types.Object

    Returns
    -------
    object
        To be compared.
    """
    both = (item.rsibr, item.rsibr.other)
    said = [said_by(look, getattr(looks, kind)) for looks in both for kind, look in look_types().items()]
    return map_set_of(item), said


def _told(error: Exception) -> str:
    """An error in a sentence; where it is a mistake of ours, its traceback goes to the console."""
    if isinstance(error, RsibrError | OSError):
        return str(error)
    traceback.print_exception(error)
    return f"The preview failed ({type(error).__name__}: {error}): see the console, and report it."
