"""What was baked before a .blend was saved moves beside it, so that both can be handed on together."""

import filecmp
import shutil
from contextlib import suppress
from pathlib import Path

import bpy
from bpy.app.handlers import persistent

from ..core.errors import OutputFileError
from ..files.atomic import written_aside
from .map_sets import stored_path
from .preferences import baked_folder, make_writable, user_folder


@persistent
def bring_baked_files(saved_as: str, *_: object) -> None:
    """Copy files from among the user's into the folder of baked files, and use the copies.

    What cannot be copied is used where it is.

    Parameters
    ----------
    saved_as : str
        Path that Blender is about to save to; empty for its start-up file.
    """
    users, folder = user_folder(), baked_folder(bpy.data.filepath or saved_as)
    for image in bpy.data.images if users != folder else ():
        path = Path(bpy.path.abspath(image.filepath))
        if path.parent == users and image.is_editable and not image.packed_file:
            with suppress(OSError, OutputFileError):
                image.filepath = stored_path(_copied(path, folder))


def _copied(path: Path, folder: Path) -> Path:
    """The copy of a file; the file itself where another one of its name is there."""
    copy = folder / path.name
    if copy.exists():
        return copy if filecmp.cmp(path, copy, shallow=False) else path
    make_writable(folder)
    with written_aside(copy) as aside:
        shutil.copyfile(path, aside)
    return copy
