"""Library overrides of what objects keep of ours.

Blender compares an override with the linked object, property by property, and keeps the differences. Where
one of both has no group of ours, as nothing in it was ever set, Blender notes the group as a whole, cannot
read that back, and all of it is lost. So both are given every group.
"""

import bpy
from bpy.app.handlers import persistent


def complete_override(item: bpy.types.ID) -> None:
    """Give an object and the linked one all groups of ours, if it is an override that has any."""
    if item.override_library and item.override_library.reference:
        for name in ("rsibr", "rsibr_baked"):
            if item.is_property_set(name):
                _complete(getattr(item, name))
                _complete(getattr(item.override_library.reference, name))


@persistent
def complete_overrides(*_: object) -> None:
    """Do so for all; to be called when linked objects have come anew, and before a file is saved."""
    for item in bpy.data.objects:
        complete_override(item)


def _complete(group: bpy.types.PropertyGroup) -> None:
    """Reading a group makes it."""
    for prop in group.bl_rna.properties:
        if prop.type == "POINTER" and prop.identifier != "rna_type":
            inner = getattr(group, prop.identifier)
            if isinstance(inner, bpy.types.PropertyGroup):
                _complete(inner)
