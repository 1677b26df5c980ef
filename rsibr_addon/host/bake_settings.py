"""An artist's choices for a bake: the scene's settings and the active object, as names and paths."""

from collections.abc import Collection
from pathlib import Path
from typing import Any, Protocol

import bpy

from ..core.errors import InputFileError, SceneError
from ..files.pictures import split_layer
from .installation import studio_environments
from .map_sets import Settings, chosen_path, stored_path, use_file, written_file
from .materials import check_saved, surface_output
from .plain_settings import apply_settings
from .worlds import world_of

SHAPED = ("MESH", "CURVE", "SURFACE", "FONT", "META")
"""Types of objects with surfaces."""


class LightSettings(Settings, Protocol):
    """`ui.bake_properties.RSIBR_PG_bake`."""

    light: str
    studio: str
    picture: str
    layer: str


def chosen_picture(settings: LightSettings) -> str:
    """The light's picture as Blender writes paths, FILE.exr:LAYER if a layer is named; empty for none."""
    path = chosen_path(settings)
    return f"{path}:{settings.layer}" if path and settings.layer else path


def use_picture(settings: LightSettings, path: str) -> None:
    """Choose the light's picture, as `chosen_picture` returns it; it need not exist."""
    _, layer = split_layer(bpy.path.abspath(path))
    settings.layer = layer or ""
    use_file(settings, path.removesuffix(f":{layer}"))


def chosen_environment(chosen: LightSettings, scene: bpy.types.Scene) -> str | None:
    """The environment that settings choose.

    Parameters
    ----------
    chosen : RSIBR_PG_bake
    scene : bpy.types.Scene
        Has the world.

    Returns
    -------
    str or None
        As `tasks.light.environments.load_environment` takes it.

    Raises
    ------
    SceneError
        There is no world, or it has an image that is not saved.
    InputFileError
        No file is given, or it is missing.
    OutputFileError
        It is packed, and the disk is full.
    """
    match chosen.light:
        case "WORLD":
            check_saved(world_of(scene))
            return None
        case "STUDIO":
            return str(studio_environments()[chosen.studio])
        case _:
            picture = chosen.picture and str(written_file(chosen))
            file = existing(picture, "environment", "a latitude-longitude picture")
            return f"{file}:{chosen.layer}" if chosen.layer else file


def existing(path: str, what: str, wanted: str) -> str:
    """The absolute path of a file that was chosen.

    Parameters
    ----------
    path : str
        As Blender writes paths, also with `//`.
    what, wanted : str
        The kind of file that is needed, in short and in more words.

    Raises
    ------
    InputFileError
        None was chosen, or it is missing.
    """
    if not path:
        raise InputFileError(f"No {what} is chosen: give {wanted}.")
    absolute = bpy.path.abspath(path)
    if not Path(absolute).is_file():
        raise InputFileError(f"There is no file {absolute}: choose another.")
    return absolute


def check_choices(chosen: bpy.types.PropertyGroup) -> None:
    """Refuse a choice that only a newer version has.

    Raises
    ------
    SceneError
    """
    for prop in chosen.bl_rna.properties:
        if prop.type == "ENUM" and not getattr(chosen, prop.identifier):
            raise SceneError(
                f"{prop.name} was chosen in another version, and is unknown here: choose another."
            )


def check_object(item: bpy.types.Object | None) -> None:
    """Refuse to bake for no object, or for one that cannot be shaded.

    Raises
    ------
    SceneError
    """
    if item is None:
        raise SceneError("There is no object to bake for: select one.")
    if item.is_missing:
        raise SceneError(
            f"Object {item.name} is missing in {item.library.filepath}: bring that file back, and open this "
            f"one again."
        )
    if item.type not in SHAPED:
        raise SceneError(f"Object {item.name} has no surface: select one that has.")
    if not item.is_editable:
        raise SceneError(f"Object {item.name} belongs to another file: make it local, or an override of it.")


def own_material(item: bpy.types.Object) -> bpy.types.Material:
    """The material of an object.

    Raises
    ------
    SceneError
        It has none, or its material has no surface, or an image that is not saved.
    """
    material = item.active_material
    if material is None:
        raise SceneError(f"Object {item.name} has no material: give it one, or choose another source.")
    if surface_output(material) is None:
        raise SceneError(
            f"Material {material.name} has no surface: link a shader to the Surface of its Material Output."
        )
    check_saved(material)
    return material


def assign(numbers: Collection[int], path: Path, settings: dict[str, Any]) -> None:
    """Shade objects from a map set; those that are gone, or may not be changed, are left out.

    Parameters
    ----------
    numbers : collection of int
        Their `session_uid`, which stays while names change.
    path : Path
    settings : dict
        Settings of their bake, from `plain_settings`.
    """
    wanted = set(numbers)
    for item in [each for each in bpy.data.objects if each.session_uid in wanted and each.is_editable]:
        item.rsibr.map_set = stored_path(path)
        item.rsibr.show = True
        apply_settings(item.rsibr_baked, settings)
