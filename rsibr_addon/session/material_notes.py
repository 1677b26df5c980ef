"""What previews leave out of materials: told before anything is done, and read again only after an edit."""

from typing import Any

from ..tasks.viewport.own_materials import shown_material


class MaterialNotes:
    """Sentences about materials, for panels, which are drawn too often to read nodes each time."""

    def __init__(self) -> None:
        self._read: dict[int, tuple[str, ...]] = {}

    def of_object(self, item: Any) -> list[str]:
        """What an object in its own materials will not show of them; nothing if it shows all.

        Parameters
        ----------
        item : bpy.types.Object
        """
        materials = dict.fromkeys(slot.material for slot in item.material_slots if slot.material)
        return [note for material in materials for note in self._of(material)]

    def forget(self) -> None:
        """Read all again: materials have changed."""
        self._read.clear()

    def _of(self, material: Any) -> tuple[str, ...]:
        if material.session_uid not in self._read:
            shown = shown_material(material)
            baked = f"Material {material.name} has a bake in the background for {shown.unbaked}."
            self._read[material.session_uid] = (*([baked] if shown.unbaked else []), *shown.messages)
        return self._read[material.session_uid]
