"""Pictures that are not yet radiance, JPEG, PNG and others: the one module that knows OpenImageIO."""

import contextlib
import functools
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ..core.conventions import Array
from ..core.errors import InputFileError
from ..core.warned import warn
from .chromaticities import rec709_from
from .encoding import Encoding, named_encoding, profile_encoding
from .memory import check_memory
from .orientation import ORIENTATIONS, Orientation
from .reading import opened
from .unheard import unheard

FORMATS = ("bmp", "gif", "jpeg", "jpeg2000", "jpegxl", "png", "psd", "sgi", "targa", "tiff", "webp")
"""OpenImageIO's names of the formats of photographs and paintings."""

RAW = (".arw", ".cr2", ".cr3", ".dng", ".nef", ".nrw", ".orf", ".pef", ".raf", ".rw2", ".srw")
"""Endings of cameras' raw files. Some are TIFF files, whose small preview would be read."""

DEVELOP = "develop it, and save a TIFF of 16 bits."

JPEG, PNG = b"\xff\xd8", b"\x89PNG"
PHOTOGRAPHS = (JPEG, PNG, b"II*\0", b"MM\0*", b"RIFF")
"""First bytes of JPEG, PNG, TIFF and WebP."""

RADIANCE = {".exr": "OpenEXR", ".hdr": "Radiance HDR"}
"""Endings of formats that are read elsewhere, if a file is what its name says."""

REDUCED, SEPARATED, UNCALIBRATED = 1, 5, 65535
"""TIFF's NewSubfileType of a preview, its PhotometricInterpretation of CMYK, and Exif's ColorSpace of
pictures that are not sRGB."""

FURTHER = {
    b"hdrgm:": "a gain map for bright displays",
    b"urn:iso:std:iso:ts:21496": "a gain map for bright displays",
    b"MPF\0": "further pictures",
}
"""Mark of a further content of a JPEG, which OpenImageIO does not report -> the content in words."""

HEAD = 1 << 18
"""Bytes of a file that are searched for what OpenImageIO does not report."""

BYTES_OF_LIGHT = 24
"""Bytes of memory for each pixel besides the stored one: three floats, and a copy."""

SHARE = 1 << 20
"""Pixels that are converted at a time."""


@dataclass(frozen=True, eq=False)
class Photograph:
    """A picture as its file holds it.

    Attributes
    ----------
    stored : ndarray, shape (height, width, 3)
        Numbers of type uint8, uint16 or float32, upright, row 0 at the bottom. Alpha is left out.
    encoding : Encoding
        Meaning of the numbers.
    """

    stored: Array
    encoding: Encoding

    def encoded(self) -> Array:
        """The numbers as fractions of white.

        Returns
        -------
        ndarray, shape (height, width, 3), float32
            In [0, 1] if the file holds integers, else unchanged.
        """
        if self.stored.dtype.kind == "f":
            return self.stored
        return self.stored / np.float32(_white(self.stored))

    def radiance(self) -> Array:
        """Light, up to a factor.

        Returns
        -------
        ndarray, shape (height, width, 3), float32
            Linear Rec. 709; colours outside it are cut off at 0.
        """
        light = self._linear()
        if not np.array_equal(self.encoding.to_rec709, np.eye(3)):
            pixels = light.reshape(-1, 3)
            for start in range(0, len(pixels), SHARE):
                some = slice(start, start + SHARE)
                pixels[some] = np.maximum(pixels[some] @ self.encoding.to_rec709.T, 0.0)
        return light

    def _linear(self) -> Array:
        curves = self.encoding.curves
        if curves is None:
            return self.encoded().copy()
        light = np.empty(self.stored.shape, np.float32)
        for channel, curve in enumerate(curves):
            stored = self.stored[..., channel]
            if stored.dtype.kind == "f":
                light[..., channel] = curve(np.maximum(stored, 0.0))
            else:
                white = _white(stored)
                light[..., channel] = curve(np.arange(white + 1.0) / white).astype(np.float32)[stored]
        return light


def read_photograph(path: str | Path) -> Photograph:
    """Read a picture.

    Parameters
    ----------
    path : str or Path
        A file of one of `FORMATS`, recognised by its bytes, not by its name. The first picture of several is
        read.

    Raises
    ------
    InputFileError
        The file is missing, no such picture, truncated or damaged, or encoded for HDR displays.
    RangeError
        See `check_memory`.

    Warns
    -----
    RsibrWarning
        A statement of the file is not used; the message names it.
    """
    with _picture(path) as (source, spec, notes), opened(path) as stream:
        head = stream.read(HEAD)
        encoding = _encoding(path, spec, notes, head)
        _tell_of_the_unused(path, notes, head)
        numbers = spec.nchannels * spec.channel_bytes() + BYTES_OF_LIGHT
        check_memory(float(spec.width * spec.height * numbers), str(path), (spec.width, spec.height))
        kind = {_library().UINT8: "uint8", _library().UINT16: "uint16"}
        pixels = source.read_image(0, 0, 0, spec.nchannels, kind.get(spec.format.basetype, "float"))
        if pixels is None or source.has_error:
            raise InputFileError(
                f"{path} is truncated or damaged ({_reason(source.geterror())}): fetch it again."
            )
        # The further pictures of a PSD are the layers of the first
        if source.format_name() != "psd" and source.seek_subimage(1, 0):
            warn(f"{path} holds several pictures: the first is used.")
    if "A" in spec.channelnames and np.any(pixels[..., spec.channelindex("A")] < _white(pixels)):
        warn(f"{path} is transparent in places, which is left out: its colours count as they are.")
    upright = _orientation(notes).upright(pixels[..., : 3 if spec.nchannels >= 3 else 1])[::-1]
    return Photograph(np.broadcast_to(upright, (*upright.shape[:2], 3)), encoding)


def read_notes(path: str | Path) -> dict[str, Any]:
    """Read a file's notes about its picture.

    Parameters
    ----------
    path : str or Path
        A file of one of `FORMATS`, or OpenEXR or Radiance HDR.

    Returns
    -------
    dict
        Fields by OpenImageIO's names: those of Exif, in any format. Fractions are pairs.

    Raises
    ------
    InputFileError
        See `read_photograph`.
    """
    with _picture(path, (*FORMATS, "openexr", "hdr")) as (_, _, notes):
        return notes


def orientation_of(path: str | Path) -> Orientation:
    """The turn that makes a file's picture upright; see `read_notes`."""
    return _orientation(read_notes(path))


@contextlib.contextmanager
def _picture(
    path: str | Path, formats: tuple[str, ...] = FORMATS
) -> Iterator[tuple[Any, Any, dict[str, Any]]]:
    """An open picture, its description, and its fields by name."""
    if Path(path).suffix.lower() in RAW:
        raise InputFileError(f"{path} is a camera's raw file: {DEVELOP}")
    with opened(path):
        hints = _library().ImageSpec()
        hints.attribute("oiio:UnassociatedAlpha", 1)  # colours as they are stored
        with unheard():
            source = _library().ImageInput.open(str(path), hints)
            if source is None and (named := RADIANCE.get(Path(path).suffix.lower())):
                raise InputFileError(f"{path} is not {named}, whatever its name says: make it again.")
            if source is None or source.format_name() not in formats:
                reason = _reason(_library().geterror()) if source is None else source.format_name()
                raise InputFileError(
                    f"{path} cannot be read as a picture ({reason}): check the file, or save it as PNG."
                )
            spec = source.spec()
            notes: dict[str, Any] = {field.name: field.value for field in spec.extra_attribs}
            if notes.get("tiff:subfiletype", 0) & REDUCED:
                raise InputFileError(f"{path} begins with a small preview: {DEVELOP}")
            try:
                yield source, spec, notes
            finally:
                source.close()


UNKNOWN_KIND = "it is of no known kind"


def _reason(text: str) -> str:
    """OpenImageIO's reason why it cannot read a file, without the file's name."""
    if "could not find a format reader" in text:
        return UNKNOWN_KIND
    return text.strip().split("\n")[0].partition(' ("')[0].rstrip(".") or UNKNOWN_KIND


def _white(numbers: Array) -> float:
    """The number of a type that stands for 1."""
    return {"uint8": 255.0, "uint16": 65535.0}.get(numbers.dtype.name, 1.0)


def _orientation(notes: dict[str, Any]) -> Orientation:
    return ORIENTATIONS.get(notes.get("Orientation", 1), Orientation())


def _encoding(path: str | Path, spec: Any, notes: dict[str, Any], head: bytes) -> Encoding:
    """The encoding by the file's statements, the most precise first; sRGB where none is usable."""
    # PNG's cICP precedes its profile
    if "ICCProfile" in notes and "CICP" not in notes:
        try:
            return profile_encoding(np.asarray(notes["ICCProfile"], np.uint8).tobytes())
        except ValueError as error:
            name = notes.get("ICCProfile:profile_description", "without a name")
            warn(
                f"{path} has a colour profile ({name!r:.60}) that cannot be used, as {error}: it is taken as "
                f"sRGB."
            )
            return named_encoding("srgb_rec709")
    floats = spec.format.basetype in (_library().HALF, _library().FLOAT, _library().DOUBLE)
    name = notes.get("oiio:ColorSpace", "lin_rec709" if floats else "srgb_rec709")
    if name.startswith(("pq_", "hlg_")):
        raise InputFileError(f"{path} is encoded for HDR displays ({name}): save it as OpenEXR.")
    try:
        encoding = named_encoding(name)
        if head.startswith(PNG) and "CICP" not in notes and b"sRGB" not in head:
            encoding = replace(encoding, to_rec709=_png_primaries(head))
    except (KeyError, ValueError):
        warn(f"{path} is of a colour space ({name}) that is unknown here: it is taken as sRGB.")
        return named_encoding("srgb_rec709")
    return encoding


def _png_primaries(head: bytes) -> Array:
    """To Rec. 709 from the primaries of a PNG's chunk cHRM, which OpenImageIO ignores."""
    at = head.find(b"cHRM") + 4
    if not 4 <= at <= len(head) - 32:
        return np.eye(3)
    x_and_y = np.frombuffer(head, ">u4", 8, at) / 1e5
    return rec709_from(np.roll(x_and_y, -2))  # white comes first


def _tell_of_the_unused(path: str | Path, notes: dict[str, Any], head: bytes) -> None:
    """Warn of statements and contents of a file that would change its picture and are not used."""
    if "jpeg:ColorSpace" in notes or notes.get("tiff:PhotometricInterpretation") == SEPARATED:
        warn(f"{path} is made for print (CMYK), whose profile is not used: its colours are rough.")
    if notes.get("Exif:ColorSpace") == UNCALIBRATED and "ICCProfile" not in notes:
        warn(f"{path} says that its colours are not those of sRGB, but not which: they are taken as sRGB.")
    for held in {what for mark, what in FURTHER.items() if head.startswith(JPEG) and mark in head}:
        warn(f"{path} holds {held} as well: its plain picture alone is used.")


@functools.cache
def _library() -> Any:
    """OpenImageIO: its import takes a tenth of a second, which pictures of radiance do not need."""
    import OpenImageIO  # type: ignore[import-not-found, unused-ignore]  # checked where it is installed

    return OpenImageIO
