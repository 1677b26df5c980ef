"""Blender's own files: what names them, opening them, and copies of the open one."""

import re
from pathlib import Path

import bpy

from ..core.errors import InputFileError, OutputFileError


def blend_name(spec: str) -> tuple[str, str] | None:
    """File and name of ``FILE.blend:NAME``; no file, an empty text, of ``:NAME``; None of any other text."""
    # Names may hold colons, and so may paths: C:\materials.blend:red:dark
    parsed = re.fullmatch(r"(|.+?\.blend\d*):(.+)", spec, flags=re.IGNORECASE | re.DOTALL)
    return (parsed[1], parsed[2]) if parsed else None


def open_blend(path: Path) -> None:
    """Open a file in place of the one that is open.

    Raises
    ------
    InputFileError
        It is missing, or Blender cannot read it.
    """
    check_there(path)
    try:
        bpy.ops.wm.open_mainfile(filepath=str(path.resolve()), load_ui=False)
    except RuntimeError as error:
        raise unreadable(path) from error


def is_file_open() -> bool:
    """Whether the open scenes are those of a file, and not what Blender starts with."""
    return bool(bpy.data.filepath)


def is_open(path: Path) -> bool:
    """Whether a file is the one that is open."""
    return bool(bpy.data.filepath) and Path(bpy.data.filepath) == path.resolve()


def check_there(path: Path) -> None:
    """Refuse a missing file.

    Raises
    ------
    InputFileError
    """
    if not path.is_file():
        raise InputFileError(f"There is no file {path}: check the path.")


def unreadable(path: Path) -> InputFileError:
    """The error to raise when Blender cannot read a file."""
    version = ".".join(map(str, bpy.app.version[:2]))
    return InputFileError(
        f"{path} is no file that Blender {version} can read: save it with Blender {version}."
    )


def path_of_open() -> str:
    """Path of the open file; empty before it is saved."""
    return bpy.data.filepath


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
