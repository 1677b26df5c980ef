"""What a camera notes in its photographs: Exif, in JPEG and in TIFF."""

import struct
from dataclasses import dataclass
from pathlib import Path

from ..core.errors import InputFileError
from .reading import opened

EXIF_FOLDER, EXPOSURE_TIME, F_NUMBER, SENSITIVITY = 0x8769, 0x829A, 0x829D, 0x8827
SHORT, LONG, RATIONAL = 3, 4, 5
START_OF_SCAN = 0xDA
LARGEST_HEAD = 1 << 20
"""Bytes of a file that are looked through; an Exif segment has 64 KiB at most."""


@dataclass(frozen=True)
class Exposure:
    """How a photograph was exposed.

    Attributes
    ----------
    time : float
        [s], above 0.
    f_number : float or None
        Focal length over aperture.
    sensitivity : float or None
        ISO.
    """

    time: float
    f_number: float | None
    sensitivity: float | None


def read_exposure(path: str | Path) -> Exposure:
    """Read how a photograph was exposed.

    Parameters
    ----------
    path : str or Path
        JPEG or TIFF.

    Returns
    -------
    Exposure

    Raises
    ------
    InputFileError
        The file is missing or unreadable, or tells no exposure time.
    """
    with opened(path) as stream:
        head = stream.read(LARGEST_HEAD)
    try:
        fields = _fields(_tiff(head))
    except (struct.error, IndexError):  # it is cut off, or nonsense
        fields = {}
    time = fields.get(EXPOSURE_TIME, 0.0)
    if not time > 0.0:
        raise InputFileError(f"{path} does not tell its exposure time: give the times of all photographs.")
    return Exposure(time, fields.get(F_NUMBER) or None, fields.get(SENSITIVITY) or None)


def relative_exposures(exposures: list[Exposure]) -> list[float]:
    """Exposures to be compared with each other.

    Parameters
    ----------
    exposures : list of Exposure

    Returns
    -------
    list of float
        Times [s], where aperture or sensitivity differ from the first photograph's made longer or
        shorter accordingly; what a photograph does not tell counts as unchanged.
    """
    first = exposures[0]
    relative = []
    for exposure in exposures:
        factor = 1.0
        if exposure.sensitivity and first.sensitivity:
            factor *= exposure.sensitivity / first.sensitivity
        if exposure.f_number and first.f_number:
            factor *= (first.f_number / exposure.f_number) ** 2
        relative.append(exposure.time * factor)
    return relative


def _tiff(head: bytes) -> bytes:
    """The TIFF structure in a file, which holds the fields; empty where there is none."""
    if head.startswith((b"II*\0", b"MM\0*")):
        return head
    if not head.startswith(b"\xff\xd8"):
        return b""
    at = 2
    while head[at] == 0xFF and head[at + 1] != START_OF_SCAN:
        (length,) = struct.unpack_from(">H", head, at + 2)
        segment = head[at + 4 : at + 2 + length]
        if segment.startswith(b"Exif\0\0"):
            return segment[6:]
        at += 2 + length
    return b""


def _fields(tiff: bytes) -> dict[int, float]:
    """The first number of each field in the first folder and in that of Exif."""
    if not tiff:
        return {}
    order = "<" if tiff.startswith(b"II") else ">"
    (first,) = struct.unpack_from(order + "I", tiff, 4)
    fields = _folder(tiff, order, first)
    if EXIF_FOLDER in fields:
        fields |= _folder(tiff, order, int(fields[EXIF_FOLDER]))
    return fields


def _folder(tiff: bytes, order: str, at: int) -> dict[int, float]:
    fields = {}
    (count,) = struct.unpack_from(order + "H", tiff, at)
    for entry in range(at + 2, at + 2 + 12 * count, 12):
        tag, kind, _ = struct.unpack_from(order + "HHI", tiff, entry)
        if kind == SHORT:
            (fields[tag],) = struct.unpack_from(order + "H", tiff, entry + 8)
        elif kind == LONG:
            (fields[tag],) = struct.unpack_from(order + "I", tiff, entry + 8)
        elif kind == RATIONAL:
            (place,) = struct.unpack_from(order + "I", tiff, entry + 8)
            numerator, denominator = struct.unpack_from(order + "II", tiff, place)
            if denominator:
                fields[tag] = numerator / denominator
    return fields
