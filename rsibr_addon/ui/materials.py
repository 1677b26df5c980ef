"""The materials of an object, as what it will be shaded with."""

import bpy

from ..session.running import session
from .sentences import tell

SLOTS_SHOWN = 6
"""Materials that are listed; more would push the button out of sight."""


def draw_materials(layout: bpy.types.UILayout, item: bpy.types.Object, width: int) -> None:
    """List an object's materials with their pictures, and tell what of them is not shown.

    Parameters
    ----------
    layout : bpy.types.UILayout
    item : bpy.types.Object
    width : int
        Width of the region in pixels.
    """
    materials = list(dict.fromkeys(slot.material for slot in item.material_slots if slot.material))
    if not materials:
        layout.template_ID(item, "active_material", new="material.new")
    for material in materials[:SLOTS_SHOWN]:
        layout.label(text=material.name, icon_value=bpy.types.UILayout.icon(material))
    if len(materials) > SLOTS_SHOWN:
        layout.label(text=f"and {len(materials) - SLOTS_SHOWN} more", icon="BLANK1")
    for note in session().material_notes.of_object(item):
        tell(layout, note, width, icon="INFO")
