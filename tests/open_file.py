"""All that an artist could notice of the open file, to be compared before and after; and a linked cube."""

import warnings
from pathlib import Path
from typing import Any

import bpy

UNSTEADY = {"rna_type", "pixels", "has_data", "tag"}
"""Properties left out: an image's pixels are many, looking at an image loads it, tags are Blender's."""

DEPTH = 3
"""Of structs within structs that are looked into: scene.render.image_settings.file_format."""


def open_file_state() -> dict[str, Any]:
    """Every datablock with its users and settings; what is selected, active, shown, and listening."""
    with warnings.catch_warnings(action="ignore", category=DeprecationWarning):
        return _state(bpy.context)


def linked_cube(library: Path) -> bpy.types.Object:
    """Save the open file, with its cube, as a library; link the cube from there into an empty file."""
    bpy.ops.wm.save_as_mainfile(filepath=str(library))
    bpy.ops.wm.read_homefile(use_empty=True)
    with bpy.data.libraries.load(str(library), link=True) as (_, wanted):
        wanted.objects = ["Cube"]
    (cube,) = wanted.objects
    return cube


def _state(context: bpy.types.Context) -> dict[str, Any]:
    handlers = {name: getattr(bpy.app.handlers, name) for name in dir(bpy.app.handlers)}
    return {
        "datablocks": {
            f"{type(item).__name__} {item.name_full}": (item.users, _settings(item, DEPTH))
            for item in bpy.data.all_ids
        },
        "selected": sorted(item.name for item in context.selected_objects),
        "active": context.active_object and context.active_object.name,
        "scene": context.scene.name,
        "dirty": bpy.data.is_dirty,
        "file": bpy.data.filepath,
        "handlers": {name: list(value) for name, value in handlers.items() if isinstance(value, list)},
    }


def _settings(struct: bpy.types.bpy_struct, depth: int) -> dict[str, Any]:
    settings = {}
    for prop in struct.bl_rna.properties:
        if prop.identifier in UNSTEADY:
            continue
        value = getattr(struct, prop.identifier, None)
        if prop.type == "POINTER":
            if isinstance(value, bpy.types.ID):
                settings[prop.identifier] = value.name
            elif value is not None and depth:
                settings[prop.identifier] = _settings(value, depth - 1)
        elif prop.type == "COLLECTION":
            settings[prop.identifier] = len(value)
        elif getattr(prop, "is_array", False):
            settings[prop.identifier] = repr(value[:])
        else:
            settings[prop.identifier] = repr(value)
    return settings
