"""Groups of properties as plain settings, for JSON and for other groups."""

from typing import Any

import bpy


def plain_settings(group: bpy.types.PropertyGroup) -> dict[str, Any]:
    """A group's settings, without those that this version does not know.

    Returns
    -------
    dict
        Name -> text, number or truth; for a group within, such a dict.
    """
    settings: dict[str, Any] = {}
    for prop in group.bl_rna.properties:
        # What is not saved shows what others say
        if prop.is_skip_save or prop.identifier in bpy.types.PropertyGroup.bl_rna.properties:
            continue
        value = getattr(group, prop.identifier)
        if prop.type == "POINTER":
            if isinstance(value, bpy.types.PropertyGroup):  # a path stands for an image
                settings[prop.identifier] = plain_settings(value)
        elif prop.type != "ENUM" or value:
            settings[prop.identifier] = value
    return settings


def apply_settings(group: bpy.types.PropertyGroup, settings: dict[str, Any]) -> None:
    """Set a group to the settings that `plain_settings` returned for another."""
    for name, value in settings.items():
        if isinstance(value, dict):
            apply_settings(getattr(group, name), value)
        else:
            setattr(group, name, value)
