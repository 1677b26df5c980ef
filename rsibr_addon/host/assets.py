"""Libraries of Blender's assets."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import bpy
import numpy as np

from ..core.conventions import Array
from ..core.errors import OutputFileError

LIBRARY = "RSIBR"
"""Name of the library in the user's preferences, and of our materials' author."""


@dataclass(frozen=True, eq=False)
class Asset:
    """A material as an asset.

    Attributes
    ----------
    material : bpy.types.Material
    title, summary : str
        Its name for people, and a line about it.
    picture : ndarray, shape (n, n, 4)
        In [0, 1], as displayed, not premultiplied; row 0 at the bottom.
    """

    material: bpy.types.Material
    title: str
    summary: str
    picture: Array


def write_library(path: Path, assets: Sequence[Asset]) -> None:
    """Write materials into a file, as assets with pictures.

    Parameters
    ----------
    path : Path
        NAME.blend.
    assets : sequence of Asset
        Their materials become assets in the open file too.

    Raises
    ------
    OutputFileError
    """
    for asset in assets:
        asset.material.name = asset.title
        asset.material.asset_mark()
        told = asset.material.asset_data
        told.description, told.author = asset.summary, LIBRARY
        preview = asset.material.preview_ensure()
        preview.image_size = asset.picture.shape[1::-1]
        preview.image_pixels_float.foreach_set(asset.picture.astype(np.float32).ravel())
    materials = {asset.material for asset in assets}
    try:
        bpy.data.libraries.write(str(path), materials, fake_user=True, compress=True)
    except (OSError, RuntimeError) as error:
        raise OutputFileError(f"No materials can be written to {path}: free some space.") from error


def asset_folder(extension: str) -> Path:
    """The folder of our assets among the user's files, which upgrades keep.

    Parameters
    ----------
    extension : str
        Name of the extension's package.

    Raises
    ------
    OutputFileError
        It cannot be made.
    """
    try:
        return Path(bpy.utils.extension_path_user(extension, path="assets", create=True))
    except (OSError, ValueError) as error:
        raise OutputFileError(f"The extension has no folder for assets among the user's: {error}.") from error


def add_library(folder: Path) -> None:
    """Have Blender's asset browsers show a folder, if none of the user's libraries does."""
    libraries = bpy.context.preferences.filepaths.asset_libraries
    if not any(Path(each.path) == folder for each in libraries):
        libraries.new(name=LIBRARY, directory=str(folder))
        bpy.context.preferences.is_dirty = True
