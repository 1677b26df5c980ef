"""The materials of an object, as what it will be shaded with."""

import bpy

MOST_ROWS = 4
"""Slots that are listed without scrolling."""


def draw_materials(layout: bpy.types.UILayout, item: bpy.types.Object) -> None:
    """Show the material of an object's active slot, and choose the slot if there are several.

    Parameters
    ----------
    layout : bpy.types.UILayout
    item : bpy.types.Object
    """
    if len(item.material_slots) > 1:
        rows = min(len(item.material_slots), MOST_ROWS)
        slots = ("material_slots", item, "active_material_index")
        layout.template_list("MATERIAL_UL_matslots", "", item, *slots, rows=rows)
    row = layout.row(align=True)
    row.template_ID(item, "active_material", new="material.new")
    row.operator("rsibr.add_materials", text="", icon="ASSET_MANAGER")
