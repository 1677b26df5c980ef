"""Radiance HDR pictures (.hdr, .pic): a shared exponent per pixel, in three codings.

The format is [Ward1991]'s: a text header, a line with the axes and the size, then scanlines.
"""

import os
from pathlib import Path

import numpy as np

from ..core.conventions import Array, Indices
from ..core.errors import InputFileError, RangeError, ShapeError
from ..core.warned import warn
from .atomic import written_aside
from .memory import check_memory
from .radiance_header import LONGEST, RadianceHeader, parse_header
from .reading import opened

MAGIC = b"#?"
"""Beginning of every file of the format."""

NEW_CODING_WIDTHS = range(8, 0x8000)
"""Widths that the newer run-length coding can state."""

GREATEST_SIDE = 1 << 16
"""Longest side of a picture in pixels: with the older run lengths, a few bytes can state more than any memory
holds."""

BYTES_OF_TEXEL = 20
"""Bytes of memory for each texel beside the file's own: 3 floats, 4 of the decoded lines, and a reserve."""

TEXELS_AT_ONCE = 1 << 15
"""Texels that are converted at a time, so that their data stay in a processor's cache."""

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
    RangeError
        It is too large for this machine's memory.

    Warns
    -----
    RsibrWarning
        A line of the header is not used, or cannot be read; the message quotes it.

    Notes
    -----
    A mantissa m and an exponent e stand for m 2^(e - 136), as Blender reads them; Radiance's own
    programs take the middle of the step instead, m + 1/2, which is brighter by 1/2 to 1/4 of a percent.
    """
    with opened(path) as stream:
        beginning = stream.read(LONGEST)
        length = stream.seek(0, os.SEEK_END)
        header, start = _header(path, beginning, length)
        check_memory(header.line_count * header.line_length * BYTES_OF_TEXEL, str(path), header.size, length)
        stream.seek(0)
        data = stream.read()
    for remark in header.remarks:
        warn(f"{path} {remark}")
    rgbe = np.empty((header.line_count, header.line_length, 4), np.uint8)
    surely_whole = True
    for index in range(header.line_count):
        try:
            rgbe[index], start, as_announced = _decode_line(data, start, header.line_length)
        except (IndexError, ValueError) as error:
            raise _damaged(path, f"in scanline {index + 1} of {header.line_count}") from error
        surely_whole &= as_announced
    if not surely_whole and start != len(data):
        raise _damaged(path, "in a scanline that states another length")
    picture: Array = np.empty((*header.size[::-1], 3), np.float32)
    lines = _lines_of(picture, header.axes)
    matrix = None if np.array_equal(header.matrix, np.eye(3)) else header.matrix.T.astype(np.float32)
    rows = max(TEXELS_AT_ONCE // header.line_length, 1)
    for first in range(0, header.line_count, rows):
        band = slice(first, first + rows)
        lines[band] = _radiance(rgbe[band])
        if matrix is not None:
            with np.errstate(over="ignore", invalid="ignore"):  # an exposure near 0 leads to infinity
                lines[band] = lines[band] @ matrix
    return picture


def read_hdr_header(path: str | Path) -> RadianceHeader:
    """Read the header, up to the pixels.

    Raises
    ------
    InputFileError
        As `read_hdr`, except for the pixels.
    """
    with opened(path) as stream:
        beginning = stream.read(LONGEST)
        return _header(path, beginning, stream.seek(0, os.SEEK_END))[0]


def write_hdr(path: str | Path, radiance: Array, force: bool = False, comments: str = "") -> None:
    """Write a Radiance picture: RGBE, flat, which every reader of the format knows.

    Parameters
    ----------
    path : str or Path
    radiance : ndarray, shape (height, width, 3)
        Linear Rec. 709, row 0 at the bottom, at least 0. The greatest component of a pixel keeps 8
        significant bits (an error of 1/256 at most), the others the same absolute precision.
    force : bool
        Whether an existing file is replaced.
    comments : str
        A line that the header states.

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
    Rounded for readers that read m and e as m 2^(e - 136), as `read_hdr` and Blender do.
    """
    if radiance.ndim != 3 or radiance.shape[2] != 3:
        raise ShapeError(f"{path} takes a picture of shape (height, width, 3), not {radiance.shape}.")
    if not np.all((radiance >= 0.0) & (radiance < GREATEST)):
        raise RangeError(f"{path} cannot hold values that are negative, NaN or above 1e38: write an EXR.")
    height, width = radiance.shape[:2]
    stated = f"COMMENTS={comments}\n" if comments else ""
    header = f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n{stated}\n-Y {height} +X {width}\n"
    with written_aside(path, force) as aside:
        aside.write_bytes(header.encode() + _rgbe(radiance[::-1]).tobytes())


def _header(path: str | Path, data: bytes, length: int) -> tuple[RadianceHeader, int]:
    """The header in the beginning of a file of `length` bytes, and the start of the pixels."""
    if not data.startswith(MAGIC):
        raise InputFileError(f"{path} is not a Radiance picture: convert it, or give another.")
    try:
        header, start = parse_header(data)
    except ValueError as error:
        raise InputFileError(f"{path} has a header that cannot be read ({error}): convert it.") from error
    available = length - start
    if max(header.size) > GREATEST_SIDE or available < header.line_count * _least_bytes(header.line_length):
        size = "{}x{}".format(*header.size)
        raise _damaged(path, f"as {available} bytes cannot hold the {size} pixels that it states")
    return header, start


def _damaged(path: str | Path, where: str) -> InputFileError:
    return InputFileError(f"{path} is truncated or damaged {where}: fetch or make it again.")


def _least_bytes(length: int) -> int:
    """Least bytes of a scanline, one of a single colour: by digits to the base 256, or by runs of 127."""
    digits = ((length - 1).bit_length() + 7) // 8
    runs = 4 + 4 * 2 * -(-length // 127)
    return min(4 + 4 * digits, runs) if length in NEW_CODING_WIDTHS else 4 + 4 * digits


def _decode_line(data: bytes, start: int, length: int) -> tuple[Indices, int, bool]:
    """One scanline as (length, 4) bytes, where the next one starts, and whether that is sure.

    A line of flat pixels may begin like one in the newer coding, but then states another length: such a
    picture must end where its pixels do, or it is damaged.
    """
    if length in NEW_CODING_WIDTHS and data[start : start + 2] == b"\2\2" and data[start + 2] < 0x80:
        if data[start + 2] << 8 | data[start + 3] == length:
            return *_decode_components(data, start + 4, length), True
        return *_decode_pixels(data, start, length), False
    return *_decode_pixels(data, start, length), True


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
    is_marker = (pixels[:, 0] == 1) & (pixels[:, 1] == 1) & (pixels[:, 2] == 1)
    if available == length and not is_marker.any():
        return pixels, at + 4 * length
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
    unit = np.ldexp(np.float32(1.0), np.arange(256) - 136)
    unit[0] = 0.0
    return rgbe[..., :3].astype(np.float32) * unit[rgbe[..., 3:]]


def _rgbe(radiance: Array) -> Indices:
    """Mantissas and the shared exponent nearest to values, shape (..., 4); below 2^-128 is black.

    The greatest mantissa is 128 to 255, so that no pixel looks like the start of a run.
    """
    greatest = radiance.max(axis=-1).astype(np.float64)
    exponent = np.frexp(greatest)[1]
    # A mantissa that rounds up to 256 needs the next exponent.
    exponent += np.rint(np.ldexp(greatest, 8 - exponent)) > 255.0
    mantissas = np.rint(np.ldexp(radiance.astype(np.float64), 8 - exponent[..., None]))
    rgbe = np.concatenate([mantissas, exponent[..., None] + 128.0], axis=-1)
    rgbe[(exponent < -127) | (greatest == 0.0)] = 0.0
    return rgbe.astype(np.uint8)


def _lines_of(picture: Array, axes: str) -> Array:
    """The scanlines along `axes`, such as "-Y+X", of a picture with row 0 at the bottom: a view of it."""
    slow, fast = axes[:2], axes[2:]
    lines = picture if slow[1] == "Y" else picture.transpose(1, 0, 2)
    return lines[:: -1 if slow[0] == "-" else 1, :: -1 if fast[0] == "-" else 1]
