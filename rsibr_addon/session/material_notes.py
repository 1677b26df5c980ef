"""What previews leave out of materials: told before anything is done, and read again only after an edit."""

from typing import Any

from ..core.errors import RsibrError
from ..host.principled import principled


class MaterialNotes:
    """Sentences about materials, for panels, which are drawn too often to read nodes each time."""

    def __init__(self) -> None:
        self._read: dict[int, str] = {}

    def of(self, material: Any) -> str:
        """What an object in its own materials will not show of one; empty if it shows all.

        Parameters
        ----------
        material : bpy.types.Material
        """
        if material.session_uid not in self._read:
            self._read[material.session_uid] = _note(material)
        return self._read[material.session_uid]

    def forget(self) -> None:
        """Read all again: materials have changed."""
        self._read.clear()


def _note(material: Any) -> str:
    try:
        missing = principled(material).missing
    except RsibrError as error:
        return str(error)
    return f"{material.name} is shown without {_listed(missing)}." if missing else ""


def _listed(words: tuple[str, ...]) -> str:
    return " and ".join(filter(None, (", ".join(words[:-1]), words[-1])))
