"""What the user's preferences say: where baked files go, which farm there is, and what is baked by itself."""

import os
from pathlib import Path
from typing import Any

import bpy

from ..core.errors import OutputFileError, SceneError
from .installation import blender_program

EXTENSION = __package__.rpartition(".rsibr_addon")[0]
"""The package name under which Blender knows us."""

FOLDER = "//rsibr"
"""Folder of baked files, beside a saved file."""


def enable_extension() -> None:
    """Have Blender know our properties and our render engine, where nobody has enabled the extension."""
    if not hasattr(bpy.types.Scene, "rsibr_render"):
        bpy.ops.preferences.addon_enable(module=EXTENSION)


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
            f"{folder} cannot be made ({error.strerror}): choose another folder in the extension's "
            "preferences."
        ) from error
    if not os.access(folder, os.W_OK | os.X_OK):
        raise OutputFileError(
            f"{folder} cannot be written to: choose another folder in the extension's preferences."
        )


def user_folder() -> Path:
    """The extension's own folder among the user's files, which upgrades keep."""
    try:
        return Path(bpy.utils.extension_path_user(EXTENSION, path="baked"))
    except ValueError:  # Not installed as an extension, but imported from elsewhere.
        return Path(bpy.utils.user_resource("DATAFILES", path="rsibr"))


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
