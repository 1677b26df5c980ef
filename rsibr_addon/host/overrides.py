"""Library overrides of what objects keep of ours."""

import bpy
from bpy.app.handlers import persistent


@persistent
def complete_references(*_: object) -> None:
    """Give linked objects the groups that their overrides have; to be called before a file is saved.

    Blender compares an override with the linked object, property by property, and keeps differences. Where
    the linked object has no group of ours, as nothing in its file was ever set, Blender notes the group as a
    whole, cannot read that back, and all of it is lost.
    """
    for item in bpy.data.objects:
        if item.override_library and item.override_library.reference:
            for name in ("rsibr", "rsibr_baked"):
                if item.is_property_set(name):
                    _complete(getattr(item.override_library.reference, name))


def _complete(group: bpy.types.PropertyGroup) -> None:
    """Reading a group makes it."""
    for prop in group.bl_rna.properties:
        if prop.type == "POINTER" and prop.identifier != "rna_type":
            inner = getattr(group, prop.identifier)
            if isinstance(inner, bpy.types.PropertyGroup):
                _complete(inner)
