"""What previews leave out of materials: told before anything is done, and read again only after an edit."""

from typing import Any

from ..tasks.viewport.own_materials import shown_material


class MaterialNotes:
    """Sentences about materials, for panels, which are drawn too often to read nodes each time."""

    def __init__(self) -> None:
        self._read: dict[int, tuple[str, tuple[str, ...]]] = {}  # of the bake that it needs, and all others

    def of_object(self, item: Any, is_shown: bool) -> list[str]:
        """What an object in its own materials will not show of them, or not at once.

        Parameters
        ----------
        item : bpy.types.Object
        is_shown : bool
            Whether a preview shows these materials: then it tells of their bakes itself.

        Returns
        -------
        list of str
            Empty if it shows all.
        """
        materials = dict.fromkeys(slot.material for slot in item.material_slots if slot.material)
        notes = []
        for bake, others in map(self._of, materials):
            notes += [bake] if bake and not is_shown else []
            notes += others
        return notes

    def forget(self) -> None:
        """Read all again: materials have changed."""
        self._read.clear()

    def _of(self, material: Any) -> tuple[str, tuple[str, ...]]:
        if material.session_uid not in self._read:
            shown = shown_material(material)
            bake = f"Material {material.name} has a bake in the background for {shown.unbaked}."
            self._read[material.session_uid] = bake if shown.unbaked else "", shown.messages
        return self._read[material.session_uid]
