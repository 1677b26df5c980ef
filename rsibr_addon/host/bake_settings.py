"""An artist's choices for a bake: the scene's settings and the active object, as names and paths."""

import os
from collections.abc import Collection
from pathlib import Path
from typing import Any, Protocol

import bpy

from ..core.errors import InputFileError, OutputFileError, SceneError
from ..files.pictures import split_layer
from .installation import studio_environments
from .map_sets import Settings, chosen_path, stored_path, use_file, written_file
from .materials import check_saved, surface_output
from .worlds import world_of

EXTENSION = __package__.rpartition(".rsibr_addon")[0]
"""The package name under which Blender knows us."""

FOLDER = "//rsibr"
"""Folder of baked files, beside a saved file."""

SHAPED = ("MESH", "CURVE", "SURFACE", "FONT", "META")
"""Types of objects with surfaces."""


class LightSettings(Settings, Protocol):
    """`ui.bake_properties.RSIBR_PG_bake`."""

    light: str
    studio: str
    picture: str
    layer: str


def enable_extension() -> None:
    """Have Blender know our properties and our render engine, where nobody has enabled the extension."""
    if not hasattr(bpy.types.Scene, "rsibr_render"):
        bpy.ops.preferences.addon_enable(module=EXTENSION)


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


def baked_folder(blend: str | None = None) -> Path:
    """The folder of baked files: that of the preferences, or beside a .blend, or among the user's files.

    Parameters
    ----------
    blend : str, optional
        Path of the .blend, empty before it is saved; that of the open file by default.

    Returns
    -------
    Path
        There may be none yet: to look for a file makes no folder.
    """
    chosen = _preferences()
    wished = (chosen and chosen.folder) or FOLDER
    blend = bpy.data.filepath if blend is None else blend
    if not blend and wished.startswith("//"):
        return user_folder()
    return Path(bpy.path.abspath(wished, start=str(Path(blend).parent)))


def make_writable(folder: Path) -> None:
    """Make the folder of baked files, unless it is there, as a file is about to be written there.

    Raises
    ------
    OutputFileError
        The folder cannot be made, or written to.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputFileError(
            f"{folder} cannot be made ({error.strerror}): choose another folder in the add-on's preferences."
        ) from error
    if not os.access(folder, os.W_OK | os.X_OK):
        raise OutputFileError(
            f"{folder} cannot be written to: choose another folder in the add-on's preferences."
        )


def chosen_inputs_settings() -> Any:
    """What the user's preferences say of baked inputs; None before the extension is enabled in them."""
    chosen = _preferences()
    return chosen and chosen.inputs


def bakes_inputs_by_itself() -> bool:
    """Whether materials' inputs are baked without being asked for."""
    chosen = _preferences()
    return chosen is None or bool(chosen.bake_inputs)


def farm_address() -> str:
    """The address of the farm's manager in the user's preferences; empty for none."""
    chosen = _preferences()
    return str(chosen.farm_manager).strip() if chosen else ""


def farm_folder() -> str:
    """The farm's shared folder in the user's preferences; empty for the one that the manager says."""
    chosen = _preferences()
    return bpy.path.abspath(chosen.farm_folder) if chosen else ""


def check_online() -> None:
    """Refuse to use the network where Blender may not.

    Raises
    ------
    SceneError
    """
    if blender_program() and not bpy.app.online_access:
        raise SceneError(
            "Blender may not use the network: switch on Allow Online Access in its preferences, below System."
        )


def _preferences() -> Any:
    """`ui.preferences.RSIBR_AP_preferences`."""
    addon = bpy.context.preferences.addons.get(EXTENSION)
    return addon.preferences if addon else None


def user_folder() -> Path:
    """The extension's own folder among the user's files, which upgrades keep."""
    try:
        return Path(bpy.utils.extension_path_user(EXTENSION, path="baked"))
    except ValueError:  # Not installed as an extension, but imported from elsewhere.
        return Path(bpy.utils.user_resource("DATAFILES", path="rsibr"))


def save_copy(path: Path, scene: bpy.types.Scene) -> None:
    """Write a scene and all that it needs, with unsaved changes; the open file stays as it was.

    Parameters
    ----------
    path : Path
        The file to write.
    scene : bpy.types.Scene

    Raises
    ------
    OutputFileError

    Notes
    -----
    *Save a Copy* would rewrite the open file's relative paths and put them back, which evaluates objects
    anew: particles would be gone until the next frame.
    """
    try:
        bpy.data.libraries.write(str(path), {scene}, path_remap="ABSOLUTE")
    except (OSError, RuntimeError) as error:
        raise OutputFileError(f"No copy of the file can be written to {path}: free some space.") from error


def open_file() -> str:
    """Path of the open file; empty before it is saved."""
    return bpy.data.filepath


def blender_program() -> str:
    """The program of this Blender; empty where Blender is a module of Python."""
    return bpy.app.binary_path


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
