"""Library overrides of our properties of objects.

Blender compares an override with the linked object, property by property, and keeps the differences. If one
of the two lacks a group of ours, because nothing in it was ever set, Blender stores the group as a whole,
cannot read that back, and all of it is lost. So both get every group.
"""

import bpy
from bpy.app.handlers import persistent


def complete_override(item: bpy.types.ID) -> None:
    """Give an override that has groups of ours, and its linked object, all of them."""
    if item.override_library and item.override_library.reference:
        for name in ("rsibr", "rsibr_baked"):
            if item.is_property_set(name):
                _complete(getattr(item, name))
                _complete(getattr(item.override_library.reference, name))


@persistent
def complete_overrides(*_: object) -> None:
    """Complete all overrides; call this when linked objects are loaded, and before a file is saved."""
    for item in bpy.data.objects:
        complete_override(item)


def _complete(group: bpy.types.PropertyGroup) -> None:
    """Create an object's groups by reading them."""
    for prop in group.bl_rna.properties:
        if prop.type == "POINTER" and prop.identifier != "rna_type":
            inner = getattr(group, prop.identifier)
            if isinstance(inner, bpy.types.PropertyGroup):
                _complete(inner)
