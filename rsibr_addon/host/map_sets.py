"""The file from which an object is shaded, or the picture of the light to bake in, as an image of Blender.

So Blender looks after the file. Its path follows when the .blend is saved elsewhere, appended from or linked,
and the file may be packed. Nothing here asks for the image's pixels.
"""

import hashlib
import shutil
from pathlib import Path
from typing import Any, Protocol

import bpy

from ..core.errors import MapSetError, OutputFileError
from ..files.atomic import written_aside
from ..files.map_set import read_map_set_header
from ..files.map_set_header import content_hash
from ..files.outputs import make_folder
from ..files.read_once import read_once
from .painted import PaintedSettings, painted_files


class Settings(Protocol):
    """`properties.RSIBR_PG_preview` of an object, or `ui.bake_properties.RSIBR_PG_bake`."""

    image: Any  # A bpy.types.Image or None


class PreviewSettings(Settings, PaintedSettings, Protocol):
    """`properties.RSIBR_PG_preview`."""

    content: str


class UnpackedFiles:
    """Packed files, written out once per run of Blender, because reading a file needs a path."""

    def __init__(self) -> None:
        self._paths: dict[int, tuple[tuple[int, int], Path]] = {}

    def path(self, image: bpy.types.Image) -> Path:
        """Path for a packed image's bytes, written or not."""
        # The bytes are read only when they have changed: for every frame it would take too long
        packed = image.packed_file
        stamp = packed.as_pointer(), packed.size
        known, path = self._paths.get(image.session_uid, (None, Path()))
        if known != stamp:
            path = self._folder() / hashlib.sha256(packed.data).hexdigest() / _file_name(image)
            self._paths[image.session_uid] = stamp, path
        return path

    def forget(self, image: bpy.types.Image) -> None:
        """Note that an image is not packed; other bytes may take the place of its own."""
        self._paths.pop(image.session_uid, None)

    def write(self, image: bpy.types.Image) -> Path:
        """Write a packed image's bytes, unless this is done.

        Raises
        ------
        OutputFileError
            The disk is full.
        """
        path = self.path(image)
        if not path.is_file():
            make_folder(path.parent)
            with written_aside(path) as aside:
                aside.write_bytes(image.packed_file.data)
        return path

    def remove(self) -> None:
        """Remove all of them from the disk."""
        self._paths.clear()
        shutil.rmtree(self._folder(), ignore_errors=True)

    def _folder(self) -> Path:
        # Blender removes the folder when it ends
        return Path(bpy.app.tempdir) / "rsibr-packed"


unpacked = UnpackedFiles()
"""The packed files that this Blender has written out."""


def chosen_path(settings: Settings) -> str:
    """The file's path as Blender writes paths, absolute if it is a library's; empty if there is none."""
    image = settings.image
    if image is None:
        return ""
    return _absolute(image) if image.library else str(image.filepath)


def use_file(settings: Settings, path: str) -> None:
    """Choose a file.

    Parameters
    ----------
    settings : Settings
    path : str
        As Blender writes paths; the file need not exist. Empty for none.
    """
    settings.image = _image_of(path) if path else None


def use_map_set(settings: PreviewSettings, path: str) -> None:
    """Shade an object from a file, as `use_file`, and remember the file's content; nothing is painted now."""
    settings.painted.clear()
    use_file(settings, path)
    remember_content(settings)


def remember_content(settings: PreviewSettings) -> None:
    """Remember what an object's map set holds, and forget the settings of another's bake."""
    path, before = planned_file(settings), settings.content
    try:
        settings.content = _content_of(Path(path)) if path else ""
    except MapSetError:
        settings.content = ""
    if settings.content != before:
        settings.id_data.property_unset("rsibr_baked")


@read_once
def _content_of(path: Path) -> str:
    """The same map set is given to every object of a scene."""
    return content_hash(read_map_set_header(path))


def planned_file(settings: Settings) -> str:
    """The absolute path of the file; empty if there is none.

    For a packed file it is a file of our own, which `written_file` writes.
    """
    image = settings.image
    if image is None:
        return ""
    if image.packed_file:
        return str(unpacked.path(image))
    unpacked.forget(image)
    return _absolute(image)


def written_file(settings: Settings) -> Path:
    """The same, ready to be read: a packed file is written out.

    Raises
    ------
    OutputFileError
        It is packed, and the disk is full.
    """
    image = settings.image
    return unpacked.write(image) if image and image.packed_file else Path(planned_file(settings))


def planned_path(settings: PreviewSettings) -> str:
    """The absolute path of what shades an object: `planned_file`, or, while it is painted, one of our own."""
    file = planned_file(settings)
    return str(painted_files.path(settings, file)) if file and settings.painted else file


def written_path(settings: PreviewSettings) -> Path:
    """The same, ready to be read.

    Raises
    ------
    OutputFileError
        See `written_file`.
    MapSetError, ShapeError, RangeError, OutputFileError
        See `painted.PaintedFiles.write`.
    """
    file = written_file(settings)
    return painted_files.write(settings, file) if settings.painted and settings.image else file


def is_packed(settings: Settings) -> bool:
    """Whether an object's map set is inside the open file, or its library."""
    return settings.image is not None and settings.image.packed_file is not None


def pack(settings: Settings) -> None:
    """Pack an object's map set into the open file, for all objects that share it.

    Raises
    ------
    OutputFileError
        Blender cannot pack the file.
    """
    try:
        settings.image.pack()
    except RuntimeError as error:
        raise OutputFileError(
            f"{planned_file(settings)} cannot be packed ({error}): keep it beside the .blend."
        ) from error


def unpack(settings: Settings, folder: Path) -> Path:
    """Write an object's packed map set into a folder, and shade from that file.

    Returns
    -------
    Path
        The file; under another name if its own is taken.

    Raises
    ------
    OutputFileError
        It cannot be written.
    """
    image = settings.image
    content = image.packed_file.data
    path = folder / _file_name(image)
    if path.exists() and path.read_bytes() != content:
        path = path.with_name(f"{hashlib.sha256(content).hexdigest()[:10]}-{path.name}")
    if not path.exists():
        with written_aside(path) as aside:
            aside.write_bytes(content)
    image.filepath = stored_path(path)
    image.unpack(method="REMOVE")
    return path


def stored_path(path: Path) -> str:
    """A path for storage in the open file: relative to it where possible."""
    if not bpy.data.filepath:
        return str(path)
    try:
        return bpy.path.relpath(str(path))
    except ValueError:  # On another drive
        return str(path)


def _absolute(image: bpy.types.Image) -> str:
    return bpy.path.abspath(image.filepath, library=image.library)


def _file_name(image: bpy.types.Image) -> str:
    return Path(_absolute(image)).name


def _image_of(path: str) -> bpy.types.Image:
    """The image of a file; a packed image holds an earlier state of the file."""
    wanted = bpy.path.abspath(path)
    for image in bpy.data.images:
        if (
            image.source == "FILE"
            and image.is_editable
            and not image.packed_file
            and _absolute(image) == wanted
        ):
            return image
    image = bpy.data.images.new(Path(wanted).name, 1, 1)
    image.source, image.filepath = "FILE", path
    return image
