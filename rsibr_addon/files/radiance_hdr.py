"""Radiance HDR pictures (.hdr, .pic): a shared exponent per pixel, in three codings.

The format is [Ward1991]'s: a text header, a line with the axes and the size, then scanlines.
"""

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..core.conventions import Array, Indices
from ..core.errors import InputFileError, RangeError, ShapeError
from .atomic import written_aside
from .chromaticities import REC_709, XYZ, rec709_from
from .reading import opened

MAGIC = b"#?"
"""How every file of the format begins."""

AXES = re.compile(rb"([-+])([XY]) +(\d+) +([-+])([XY]) +(\d+) *")
NEW_CODING_WIDTHS = range(8, 0x8000)
"""Widths that the newer run-length coding can state."""

GREATEST = 255.0 * 2.0**119
"""The greatest value that the format can state."""


def read_hdr(path: str | Path) -> Array:
    """Read a Radiance picture.

    Parameters
    ----------
    path : str or Path
        RGBE or XYZE; flat, or with the older or the newer run lengths; any order of the axes.

    Returns
    -------
    ndarray, shape (height, width, 3), float32
        Radiance in linear Rec. 709, row 0 at the bottom; the exposures and colour corrections that the
        header records are undone, and primaries that it states are converted.

    Raises
    ------
    InputFileError
        The file is missing, unreadable, not a Radiance picture, or truncated or damaged.

    Notes
    -----
    A mantissa m and an exponent e stand for m 2^(e - 136), as Blender reads them; Radiance's own
    programs take the middle of the step instead, m + 1/2, which is brighter by 1/2 to 1/4 of a percent.
    """
    with opened(path) as stream:
        data = stream.read()
    if not data.startswith(MAGIC):
        raise InputFileError(f"{path} is not a Radiance picture: convert it, or give another.")
    try:
        header, start = _parse_header(data)
    except ValueError as error:
        raise InputFileError(f"{path} has a header that cannot be read ({error}): convert it.") from error
    lines = []
    for index in range(header.line_count):
        try:
            line, start = _decode_line(data, start, header.line_length)
        except (IndexError, ValueError) as error:
            raise InputFileError(
                f"{path} is truncated or damaged in scanline {index + 1} of {header.line_count}: "
                f"fetch or make it again."
            ) from error
        lines.append(line)
    return _upright(_radiance(np.stack(lines)) @ header.matrix.T.astype(np.float32), header.axes)


def write_hdr(path: str | Path, radiance: Array, force: bool = False) -> None:
    """Write a Radiance picture: RGBE, flat, which every reader of the format knows.

    Parameters
    ----------
    path : str or Path
    radiance : ndarray, shape (height, width, 3)
        Linear Rec. 709, row 0 at the bottom, at least 0. The greatest component of a pixel keeps 8
        significant bits (an error of 1/256 at most), the others the same absolute precision.
    force : bool
        Whether an existing file is replaced.

    Raises
    ------
    RangeError
        A value is negative, NaN or beyond the format's range, which ends at 1.7e38.
    ShapeError
        `radiance` has another shape.
    OutputFileError
        See `written_aside`.

    Notes
    -----
    Rounded for readers that take m and e as m 2^(e - 136), as `read_hdr` and Blender do.
    """
    if radiance.ndim != 3 or radiance.shape[2] != 3:
        raise ShapeError(f"{path} takes a picture of shape (height, width, 3), not {radiance.shape}.")
    if not np.all((radiance >= 0.0) & (radiance < GREATEST)):
        raise RangeError(f"{path} cannot hold values that are negative, NaN or above 1e38: write an EXR.")
    height, width = radiance.shape[:2]
    header = f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n"
    with written_aside(path, force) as aside:
        aside.write_bytes(header.encode() + _rgbe(radiance[::-1]).tobytes())


@dataclass(frozen=True)
class _Header:
    """What the text before the pixels says; `matrix` makes Rec. 709 radiance of the stored values."""

    axes: str
    line_count: int
    line_length: int
    matrix: Array


def _parse_header(data: bytes) -> tuple[_Header, int]:
    """The header, and where the pixels start."""
    end = re.search(rb"\r?\n\r?\n", data)
    if end is None:
        raise ValueError("it does not end")
    scale, primaries = np.ones(3), np.array(REC_709)
    for line in data[: end.start()].decode("latin-1").splitlines():
        key, _, value = line.partition("=")
        if key == "FORMAT" and value.strip() == "32-bit_rle_xyze":
            primaries = np.array(XYZ)
        elif key == "FORMAT" and value.strip() != "32-bit_rle_rgbe":
            raise ValueError(f"its format is {value.strip()}")
        elif key == "PRIMARIES":
            primaries = _numbers(value, 8)
        elif key == "EXPOSURE":
            scale = scale * _factor(_numbers(value, 1))
        elif key == "COLORCORR":
            scale = scale * _factor(_numbers(value, 3))
    line_end = data.find(b"\n", end.end())
    axes = AXES.fullmatch(data[end.end() : max(line_end, 0)].rstrip(b"\r"))
    if axes is None or {axes[2], axes[5]} != {b"X", b"Y"} or int(axes[3]) < 1 or int(axes[6]) < 1:
        raise ValueError("it states no size")
    order = b"".join(axes.group(1, 2, 4, 5)).decode()
    return _Header(order, int(axes[3]), int(axes[6]), rec709_from(primaries) / scale), line_end + 1


def _numbers(text: str, count: int) -> Array:
    numbers = np.array(text.split(), dtype=np.float64)
    if numbers.shape != (count,):
        raise ValueError(f"{text.strip()!r} are not {count} numbers")
    return numbers


def _factor(factors: Array) -> Array:
    """Factors that were multiplied in; FreeImage writes an exposure of 0, which means none."""
    return factors if np.all(np.isfinite(factors) & (factors > 0.0)) else np.ones_like(factors)


def _decode_line(data: bytes, start: int, length: int) -> tuple[Indices, int]:
    """One scanline as (length, 4) bytes, and where the next one starts."""
    if length in NEW_CODING_WIDTHS and data[start : start + 2] == b"\2\2" and data[start + 2] < 0x80:
        if data[start + 2] << 8 | data[start + 3] != length:
            raise ValueError("a scanline states another length")
        return _decode_components(data, start + 4, length)
    return _decode_pixels(data, start, length)


def _decode_components(data: bytes, at: int, length: int) -> tuple[Indices, int]:
    """The newer coding: all mantissas of red, then green, blue and the exponents, in runs of bytes."""
    line = bytearray()
    while len(line) < 4 * length:
        count = data[at]
        if count > 128:
            line += data[at + 1 : at + 2] * (count - 128)
            at += 2
        else:
            line += data[at + 1 : at + 1 + count]
            at += 1 + count
    if len(line) != 4 * length or at > len(data):
        raise ValueError("a run crosses the end")
    return np.frombuffer(line, np.uint8).reshape(4, length).T, at


def _decode_pixels(data: bytes, at: int, length: int) -> tuple[Indices, int]:
    """Flat pixels, or the older coding: (1, 1, 1, n) repeats the pixel before it n times.

    Markers in a row are digits of one number, the lowest first, to the base 256.
    """
    available = min(length, (len(data) - at) // 4)
    pixels = np.frombuffer(data, np.uint8, 4 * available, at).reshape(available, 4)
    is_marker = np.all(pixels[:, :3] == 1, axis=1)
    places = np.arange(available)
    last_pixel = np.maximum.accumulate(np.where(is_marker, -1, places))
    digit = places - last_pixel - 1
    if np.any(is_marker & ((last_pixel < 0) | (digit > 3))):
        raise ValueError("a run repeats nothing, or too often")
    repeats = np.where(is_marker, pixels[:, 3].astype(np.int64) << 8 * np.maximum(digit, 0), 1)
    reached = np.cumsum(repeats)
    used = int(np.searchsorted(reached, length)) + 1
    if used > available or reached[used - 1] != length:
        raise ValueError("a run crosses the end")
    return pixels[np.repeat(last_pixel[:used], repeats[:used])], at + 4 * used


def _radiance(rgbe: Indices) -> Array:
    """Values from mantissas and the shared exponent; an exponent of 0 is black."""
    exponent = rgbe[..., 3:].astype(np.int32)
    unit = np.where(exponent > 0, np.ldexp(np.float32(1.0), exponent - 136), np.float32(0.0))
    return rgbe[..., :3].astype(np.float32) * unit


def _rgbe(radiance: Array) -> Indices:
    """Mantissas and the shared exponent nearest to values, shape (..., 4); below 2^-128 is black.

    The greatest mantissa is 128 to 255, so that no pixel looks like the start of a run.
    """
    greatest = radiance.max(axis=-1).astype(np.float64)
    exponent = np.frexp(greatest)[1]
    # A mantissa that would be rounded up to 256 needs the next exponent.
    exponent += np.rint(np.ldexp(greatest, 8 - exponent)) > 255.0
    mantissas = np.rint(np.ldexp(radiance.astype(np.float64), 8 - exponent[..., None]))
    rgbe = np.concatenate([mantissas, exponent[..., None] + 128.0], axis=-1)
    rgbe[(exponent < -127) | (greatest == 0.0)] = 0.0
    return rgbe.astype(np.uint8)


def _upright(lines: Array, axes: str) -> Array:
    """Row 0 at the bottom, column 0 at the left, from scanlines along `axes`, such as "-Y+X"."""
    slow, fast = axes[:2], axes[2:]
    picture = lines[:: -1 if slow[0] == "-" else 1, :: -1 if fast[0] == "-" else 1]
    if slow[1] == "X":
        picture = picture.transpose(1, 0, 2)
    return np.ascontiguousarray(picture)
