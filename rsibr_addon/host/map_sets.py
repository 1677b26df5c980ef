"""The file that an object is shaded from, or the picture of the light to bake in, as one of Blender's images.

So Blender looks after it. Its path follows when the .blend is saved elsewhere, appended from or linked; and
it may be packed. What it shows is of no interest here: nothing asks for its pixels.
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


class Settings(Protocol):
    """`properties.RSIBR_PG_preview` of an object, or `ui.bake_properties.RSIBR_PG_bake`."""

    image: Any  # A bpy.types.Image or None


class PreviewSettings(Settings, Protocol):
    """`properties.RSIBR_PG_preview`."""

    content: str
    id_data: Any


class UnpackedFiles:
    """Packed files, written out once for as long as this Blender runs: who reads one needs a path."""

    def __init__(self) -> None:
        self._paths: dict[int, tuple[tuple[int, int], Path]] = {}

    def path(self, image: bpy.types.Image) -> Path:
        """Where a packed image's bytes are written to, whether they are there yet or not."""
        # They are read when they are others only: it would take long for every frame
        packed = image.packed_file
        stamp = packed.as_pointer(), packed.size
        known, path = self._paths.get(image.session_uid, (None, Path()))
        if known != stamp:
            path = self._folder() / hashlib.sha256(packed.data).hexdigest() / _file_name(image)
            self._paths[image.session_uid] = stamp, path
        return path

    def forget(self, image: bpy.types.Image) -> None:
        """Note that an image is not packed; other bytes may come to where its own were."""
        self._paths.pop(image.session_uid, None)

    def write(self, image: bpy.types.Image) -> Path:
        """Write a packed image's bytes, unless they are there.

        Raises
        ------
        OutputFileError
            The disk is full.
        """
        path = self.path(image)
        if not path.is_file():
            path.parent.mkdir(parents=True, exist_ok=True)
            with written_aside(path) as aside:
                aside.write_bytes(image.packed_file.data)
        return path

    def remove(self) -> None:
        """Take all of them from the disk."""
        self._paths.clear()
        shutil.rmtree(self._folder(), ignore_errors=True)

    def _folder(self) -> Path:
        # Blender removes it when it ends
        return Path(bpy.app.tempdir) / "rsibr-packed"


unpacked = UnpackedFiles()
"""Those of this Blender."""


def chosen_path(settings: Settings) -> str:
    """The file's path as Blender writes paths, absolute where it is a library's; empty without."""
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
        As Blender writes paths; it need not be there. Empty for none.
    """
    settings.image = _image_of(path) if path else None


def use_map_set(settings: PreviewSettings, path: str) -> None:
    """Have an object shaded from a file, as `use_file`, and remember what it holds."""
    use_file(settings, path)
    remember_content(settings)


def remember_content(settings: PreviewSettings) -> None:
    """Take what an object's map set holds now for what it is to hold; how another was baked is forgotten."""
    path, before = planned_path(settings), settings.content
    try:
        settings.content = content_hash(read_map_set_header(path)) if path else ""
    except MapSetError:
        settings.content = ""
    if settings.content != before:
        settings.id_data.property_unset("rsibr_baked")


def planned_path(settings: Settings) -> str:
    """The absolute path of the file; empty without.

    Where it is packed, that is a file of our own, which `written_path` writes.
    """
    image = settings.image
    if image is None:
        return ""
    if image.packed_file:
        return str(unpacked.path(image))
    unpacked.forget(image)
    return _absolute(image)


def written_path(settings: Settings) -> Path:
    """The same, ready to be read: written out where it is packed.

    Raises
    ------
    OutputFileError
        It is packed, and the disk is full.
    """
    image = settings.image
    return unpacked.write(image) if image and image.packed_file else Path(planned_path(settings))


def is_packed(settings: Settings) -> bool:
    """Whether an object's map set is inside the open file, or its library."""
    return settings.image is not None and settings.image.packed_file is not None


def pack(settings: Settings) -> None:
    """Take an object's map set into the open file, for all objects that share it.

    Raises
    ------
    OutputFileError
        Blender cannot pack it.
    """
    try:
        settings.image.pack()
    except RuntimeError as error:
        raise OutputFileError(
            f"{planned_path(settings)} cannot be packed ({error}): keep it beside the .blend."
        ) from error


def unpack(settings: Settings, folder: Path) -> Path:
    """Write an object's packed map set into a folder, and shade from that file.

    Parameters
    ----------
    settings : Settings
    folder : Path

    Returns
    -------
    Path
        The file; under another name where its own is another file's.

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
    """A path as the open file keeps it: relative to it where that is possible."""
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
    """The image of a file; one that is packed holds what that file was."""
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
