"""OpenEXR files, single-part or multi-part: the one module that knows the OpenEXR package."""

import contextlib
import io
import os
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
import OpenEXR

from ..core.conventions import Array, Indices
from ..core.errors import InputFileError
from ..core.threads import starting, thread_count
from .exr_part import BYTES_OF_SAMPLE, Part, window_size
from .exr_sampling import interpolated
from .memory import check_memory
from .reading import opened
from .unheard import unheard

MAGIC = b"\x76\x2f\x31\x01"
"""The first four bytes of every OpenEXR file."""

CUBE = OpenEXR.ENVMAP_CUBE
"""Value of the attribute `envmap` of a picture with a cube's six faces."""

primaries_named = OpenEXR.colorInteropIDToChromaticities
"""Chromaticities of a linear colour space by its `colorInteropID`; None for other identifiers."""

with starting():
    OpenEXR.set_global_thread_count(thread_count())

LARGEST_TILE = 2048
"""Width or height of a tile that reaches beyond its picture."""

LEAST_OF_SAMPLE = {
    **dict.fromkeys((OpenEXR.NO_COMPRESSION, OpenEXR.RLE_COMPRESSION), 2.0 / 128.0),
    **dict.fromkeys((OpenEXR.ZIP_COMPRESSION, OpenEXR.ZIPS_COMPRESSION), 2.0 / 1032.0),
    **dict.fromkeys((OpenEXR.PIZ_COMPRESSION, OpenEXR.PXR24_COMPRESSION), 2.0 / 1032.0),
    **dict.fromkeys((OpenEXR.B44_COMPRESSION, OpenEXR.B44A_COMPRESSION), 2.0 / 1032.0),
    **dict.fromkeys((OpenEXR.DWAA_COMPRESSION, OpenEXR.DWAB_COMPRESSION), 2.0 / 1032.0 / 64.0),
}
"""Compression -> least bytes of the file for each number of a channel: of half floats that are all 0.

Deflate makes one byte of 1032; DWA stores one number for 64 before that.
"""

WIDE = 4096
"""Width of pictures that are packed by PIZ: the fewer texels a chunk has, the less do its tables pay.

At 8192 texels it packs environments 1.4 to 2 times as fast as ZIP, and a tenth to a quarter smaller; at 1024
it takes up to 2.7 times as long.
"""

ROWS_OF_CHUNK = {OpenEXR.ZIP_COMPRESSION: 16, OpenEXR.PIZ_COMPRESSION: 32}
"""Rows that are packed together, by the compressions that are written."""


class OpenExr:
    """An open file: its headers, and its pixels on request.

    Parameters
    ----------
    path : str or Path
        The file's path, for messages.
    stream : BinaryIO
        Its bytes, at any place.

    Attributes
    ----------
    headers : list of dict
        For each part its attributes by name, as the OpenEXR package gives them.

    Raises
    ------
    InputFileError
        The file is not OpenEXR, or damaged in its headers.
    """

    def __init__(self, path: str | Path, stream: BinaryIO) -> None:
        self._path, self._stream = path, stream
        stream.seek(0)
        if stream.read(len(MAGIC)) != MAGIC:
            raise InputFileError(f"{path} is not an OpenEXR file: convert it, or give another.")
        with self._package_file(header_only=True) as file:
            self.headers = [dict(part.header) for part in file.parts]
        try:
            for header in self.headers:
                [channel.name for channel in header["channels"]]
        except UnicodeDecodeError as error:
            raise InputFileError(
                f"{path} has names of channels that are not UTF-8: save it again."
            ) from error

    def parts(self) -> list[Part]:
        """Read all pixels.

        Returns
        -------
        list of Part
            Every part that the headers announce, each with the pixels of its data window.

        Raises
        ------
        InputFileError
            Pixels of a part are missing or damaged; a part has deep pixels.
        RangeError
            The file is too large for this machine's memory.

        Notes
        -----
        Subsampled channels are interpolated: see `exr_sampling`.
        """
        path, headers = self._path, self.headers
        for header in headers:
            if header["type"] not in (OpenEXR.scanlineimage, OpenEXR.tiledimage):
                raise InputFileError(f"{path} holds deep pixels: flatten it, and save it as a plain OpenEXR.")
        sizes = [window_size(header["dataWindow"]) for header in headers]
        for header, size in zip(headers, sizes, strict=True):
            if header["type"] == OpenEXR.tiledimage:
                _check_tiles(path, header["tiles"], size)
        self._check_length(sizes)
        texels = sum(
            width * height * len(header["channels"])
            for header, (width, height) in zip(headers, sizes, strict=True)
        )
        check_memory(BYTES_OF_SAMPLE * texels, str(path), max(sizes))
        if all(map(_holds_rgb, headers)):
            # The headers as the package gives them do not tell whether channels have one type, without which
            # it takes none together
            with contextlib.suppress(InputFileError):
                return self._read(separate_channels=False)
        return self._read(separate_channels=True)

    def _read(self, separate_channels: bool) -> list[Part]:
        with self._package_file(separate_channels=separate_channels) as file:
            # Where the package cannot read a part's pixels, it leaves the part out, without an exception
            if left_out := len(self.headers) - len(file.parts):
                raise InputFileError(
                    f"{self._path} is truncated or damaged (pixels of {left_out} of its {len(self.headers)} "
                    f"parts cannot be read): fetch or make it again."
                )
            return [
                Part(part.header.get("name", ""), _pixels_by_name(part), dict(part.header))
                for part in file.parts
            ]

    def _check_length(self, sizes: list[tuple[int, int]]) -> None:
        """Refuse a file that cannot hold what it states: the package takes memory for all of it at once."""
        least = sum(
            LEAST_OF_SAMPLE.get(header["compression"], 0.0)
            * sum(width * height / (each.xSampling * each.ySampling) for each in header["channels"])
            for header, (width, height) in zip(self.headers, sizes, strict=True)
        )
        if least > self._stream.seek(0, os.SEEK_END):
            raise InputFileError(
                f"{self._path} is truncated or damaged (it states more than it holds): make it again."
            )

    @contextlib.contextmanager
    def _package_file(self, **options: bool) -> Iterator[Any]:
        """The file as the package opens it; its complaints become one sentence."""
        self._stream.seek(0)
        try:
            with unheard():
                file = OpenEXR.File(self._stream, **options)
        except (RuntimeError, ValueError) as error:
            raise InputFileError(f"{self._path} is truncated or damaged: fetch or make it again.") from error
        with file:
            yield file


@contextlib.contextmanager
def open_exr(path: str | Path) -> Iterator[OpenExr]:
    """Open a file to read its headers, or all of it.

    Yields
    ------
    OpenExr

    Raises
    ------
    InputFileError
        The file is missing or unreadable, or as `OpenExr`.
    """
    with opened(path) as stream:
        yield OpenExr(path, stream)


def read_attributes(path: str | Path) -> list[dict[str, Any]]:
    """Read the headers of a file, not its pixels: `OpenExr.headers`; raises as `open_exr`."""
    with open_exr(path) as file:
        return file.headers


def read_parts(path: str | Path) -> list[Part]:
    """Read a file whole.

    Returns
    -------
    list of Part
        See `OpenExr.parts`.

    Raises
    ------
    InputFileError, RangeError
        As `open_exr` and `OpenExr.parts`.
    """
    with open_exr(path) as file:
        return file.parts()


def _check_tiles(path: str | Path, tiles: Any, size: tuple[int, int]) -> None:
    """Refuse tiles that no program writes: the package takes memory for a whole one before it looks on."""
    if tiles.xSize > max(size[0], LARGEST_TILE) or tiles.ySize > max(size[1], LARGEST_TILE):
        raise InputFileError(
            f"{path} is damaged (it states tiles of {tiles.xSize}x{tiles.ySize}): fetch or make it again."
        )


def _holds_rgb(header: dict[str, Any]) -> bool:
    """Whether a part has red, green and blue in full, and nothing beside them but alpha."""
    channels = header["channels"]
    return {channel.name for channel in channels} | {"A"} == set("RGBA") and all(
        channel.xSampling == channel.ySampling == 1 for channel in channels
    )


def _pixels_by_name(part: Any) -> dict[str, Array]:
    """The channels of a part as the package has read it, row 0 at the bottom."""
    (first, channel), *_ = part.channels.items()
    if channel.pixels.ndim == 2:
        return {name: _full(channel, part.header["dataWindow"]) for name, channel in part.channels.items()}
    pixels = channel.pixels
    # In place, so that they lie as `Part.side_by_side` takes them without a copy
    for low, high in zip(range(len(pixels) // 2), reversed(range(len(pixels))), strict=False):
        pixels[[low, high]] = pixels[[high, low]]
    return {name: pixels[..., number] for number, name in enumerate(first)}


def _full(channel: Any, window: tuple[Indices, Indices]) -> Array:
    """A channel's pixels at the full size of its part, row 0 at the bottom."""
    sampling, pixels = (channel.ySampling, channel.xSampling), channel.pixels
    for axis, (step, length) in enumerate(zip(sampling, window_size(window)[::-1], strict=True)):
        pixels = interpolated(pixels, axis, step, length)
    flipped: Array = pixels[::-1]
    return flipped


def compression_of(width: int) -> Any:
    """How a picture of some width is packed, without loss."""
    return OpenEXR.PIZ_COMPRESSION if width >= WIDE else OpenEXR.ZIP_COMPRESSION


def write_parts(path: Path, parts: Sequence[Part]) -> None:
    """Write a file, packed by `compression_of`; equal parts give equal bytes.

    Parameters
    ----------
    path : Path
        Replaced if it exists: `written_aside` yields one.
    parts : sequence of Part

    Raises
    ------
    OSError
        The system refuses, or the disk is full.
    """
    shapes = [pixels.shape[:2] for part in parts for pixels in part.channels.values()]
    largest = np.max(shapes, axis=0).tolist()
    # Through our own stream, because the package's drops the error of its last bytes
    with path.open("wb") as stream:
        OpenEXR.File([_described(part, largest) for part in parts]).write(stream)


def packed(part: Part, largest: Sequence[int], top: int = 0) -> bytes:
    """The bytes of a file with one part, or with some rows of it.

    Parameters
    ----------
    part : Part
    largest : sequence of two int
        Height and width that its display window has.
    top : int
        Number of its first row, from the top.

    Returns
    -------
    bytes
        Compressed as `write_parts` does it.
    """
    stream = io.BytesIO()
    height, width = next(iter(part.channels.values())).shape[:2]
    window = np.array([0, top], np.int32), np.array([width - 1, top + height - 1], np.int32)
    attributes = part.attributes | {"dataWindow": window}
    OpenEXR.File([_described(replace(part, attributes=attributes), largest)]).write(stream)
    return stream.getvalue()


def _described(part: Part, largest: Sequence[int]) -> Any:
    """A part as the package takes it: with the display window of all parts and its own data window."""
    height, width = largest
    header = {
        "type": OpenEXR.scanlineimage,
        "compression": compression_of(next(iter(part.channels.values())).shape[1]),
        "displayWindow": (np.zeros(2, np.int32), np.array([width - 1, height - 1], np.int32)),
    }
    return OpenEXR.Part(
        {**header, **part.attributes},
        # The package reads the memory of an array without looking at its strides
        {name: np.ascontiguousarray(pixels[::-1]) for name, pixels in part.channels.items()},
        part.name,
    )
