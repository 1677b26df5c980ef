"""Maps of an object's map set as images that are being painted.

While they are, the object is shaded from a file of our own that holds them, made when it is needed.
"""

import hashlib
import shutil
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, Protocol

import bpy
import numpy as np
from bpy.app.handlers import persistent

from ..core.conventions import Array
from ..core.errors import MapSetError
from ..files.map_set import read_map_set, read_map_set_header, write_map_set
from ..files.map_set_header import content_hash
from ..files.outputs import make_folder
from ..files.painted import painted_map_set
from .working_space import rec709_from_working, working_from_rec709


class PaintedSettings(Protocol):
    """`properties.RSIBR_PG_preview`."""

    painted: Any  # A collection of `properties.RSIBR_PG_painted`
    id_data: Any


class PaintedFiles:
    """Files of painted map sets, one for each object that is painted."""

    def __init__(self) -> None:
        self._digests: dict[int, bytes] = {}
        self._written: dict[int, Path] = {}

    def changed(self, images: Iterable[bpy.types.Image]) -> None:
        """Look at the pixels of images anew."""
        for image in images:
            self._digests.pop(image.session_uid, None)

    def all_changed(self) -> None:
        """Look at the pixels of all images anew."""
        self._digests.clear()

    def path(self, settings: PaintedSettings, source: str) -> Path:
        """Path for an object's painted map set, written or not; another one after each change.

        Parameters
        ----------
        settings : PaintedSettings
        source : str
            Path of the map set whose maps are painted.
        """
        told = hashlib.sha256(source.encode())
        for each in settings.painted:
            told.update(each.name.encode() + self._digest(each.image))
        return self._folder() / told.hexdigest() / Path(source).name

    def write(self, settings: PaintedSettings, source: Path) -> Path:
        """Write an object's painted map set, unless this is done, in place of its last one.

        Raises
        ------
        MapSetError
            `source` cannot be read, or an image cannot be used.
        ShapeError, RangeError
            See `files.painted.painted_map_set`.
        OutputFileError
            The disk is full.
        """
        path = self.path(settings, str(source))
        if not path.is_file():
            make_folder(path.parent)
            write_painted(path, settings, source)
            last = self._written.get(settings.id_data.session_uid)
            if last is not None and last != path:
                shutil.rmtree(last.parent, ignore_errors=True)
        self._written[settings.id_data.session_uid] = path
        return path

    def remove(self) -> None:
        """Remove all of them from the disk."""
        self._digests.clear()
        self._written.clear()
        shutil.rmtree(self._folder(), ignore_errors=True)

    def _digest(self, image: bpy.types.Image | None) -> bytes:
        if image is None:
            return b""
        digest = self._digests.get(image.session_uid)
        # Nothing tells of changes where there is no window
        if digest is None or bpy.app.background:
            digest = hashlib.sha256(_raw_pixels(image).data).digest()
            self._digests[image.session_uid] = digest
        return digest

    def _folder(self) -> Path:
        # Blender removes the folder when it ends
        return Path(bpy.app.tempdir) / "rsibr-painted"


painted_files = PaintedFiles()
"""The painted map sets that this Blender has written out."""


def begin_painting(settings: PaintedSettings, maps: Mapping[str, Array], stem: str) -> None:
    """Have an object's maps painted.

    Parameters
    ----------
    settings : PaintedSettings
    maps : mapping of str to ndarray, shape (height, width, 3)
        Radiance by the name of a part.
    stem : str
        What the images' names begin with.
    """
    settings.painted.clear()
    for name, radiance in maps.items():
        each = settings.painted.add()
        each.name, each.image = name, _image(f"{stem} {name}", radiance)


def write_painted(path: Path, settings: PaintedSettings, source: Path) -> None:
    """Write an object's map set with its maps as they are painted.

    Raises
    ------
    MapSetError, ShapeError, RangeError, OutputFileError
        See `PaintedFiles.write`.
    """
    maps = {each.name: _painted_pixels(each.image) for each in settings.painted if each.image is not None}
    content = content_hash(read_map_set_header(source))
    write_map_set(path, painted_map_set(read_map_set(source), content, maps))


def end_painting(settings: PaintedSettings) -> None:
    """Remove the images that only this object has painted."""
    images = [each.image for each in settings.painted if each.image is not None]
    settings.painted.clear()
    for image in images:
        if image.users <= int(image.use_fake_user):
            bpy.data.images.remove(image)


@persistent
def keep_paint(*_: object) -> None:
    """Pack what has been painted; call this before a file is saved, which has no other place for it."""
    for item in bpy.data.objects:
        for each in item.rsibr.painted:
            if each.image is not None and each.image.is_editable and each.image.is_dirty:
                each.image.pack()


def _image(name: str, radiance: Array) -> bpy.types.Image:
    height, width = radiance.shape[:2]
    image = bpy.data.images.new(name, width, height, float_buffer=True)
    image.use_half_precision = False
    # So that it is kept where another map set is chosen for the object
    image.use_fake_user = True
    pixels = np.ones((height, width, 4), dtype=np.float32)
    pixels[..., :3] = working_from_rec709(radiance)
    image.pixels.foreach_set(pixels.ravel())
    image.pack()
    return image


def _painted_pixels(image: bpy.types.Image) -> Array:
    """An image's radiance, shape (height, width, 3), row 0 at the bottom."""
    if not image.is_float:
        raise MapSetError(
            f"The image {image.name} has 8 bits a channel, too few for light: use a float image."
        )
    width, height = image.size
    return rec709_from_working(_raw_pixels(image).reshape(height, width, 4)[..., :3])


def _raw_pixels(image: bpy.types.Image) -> Array:
    pixels = np.empty(len(image.pixels), dtype=np.float32)
    image.pixels.foreach_get(pixels)
    return pixels
