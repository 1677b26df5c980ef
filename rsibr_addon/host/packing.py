"""Files of Blender that hold all that they need, for machines that have nothing else."""

from pathlib import Path

import bpy

from ..core.errors import OutputFileError
from ..core.warned import warn


def write_packed(path: Path) -> None:
    """Take all that the open file uses into it, and write it as another file.

    Parameters
    ----------
    path : Path
        The file to write.

    Raises
    ------
    OutputFileError
        The file cannot be written.

    Warns
    -----
    RsibrWarning
        An image's file is missing.

    Notes
    -----
    The open file is changed: so this is for a Blender that nobody works in. Blender can pack whole libraries,
    but not the images that they name.
    """
    _make_all_local()
    for image in bpy.data.images:
        _pack(image)
    try:
        bpy.ops.wm.save_as_mainfile(filepath=str(path), copy=True, compress=True)
    except RuntimeError as error:
        raise OutputFileError(f"No copy of the file can be written to {path}: free some space.") from error


def _make_all_local() -> None:
    """Make linked data this file's own, users first: what linked data uses is copied, and stays linked."""
    tried: set[bpy.types.ID] = set()
    while True:
        users = bpy.data.user_map()
        linked = [block for block in users if block.library and block not in tried]
        if not linked:
            return
        free = [block for block in linked if not any(user.library for user in users[block])] or linked
        for block in free:
            tried.add(block)
            block.make_local()


def _pack(image: bpy.types.Image) -> None:
    if image.packed_files or image.source in ("GENERATED", "VIEWER"):
        return
    try:
        image.pack()
    except RuntimeError:
        warn(
            f"Image {image.name} cannot go with its material, as {image.filepath} is missing: bring it back."
        )
