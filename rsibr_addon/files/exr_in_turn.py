"""An OpenEXR file of many parts, written one after another, so that never more than one need be in memory.

The package wants all parts at once. Some rows of one are packed as a file of its own instead: that has the
same header, except for the data window and the number of chunks, and the same chunks, except for the number
of their part before them.
"""

import itertools
import struct
from collections.abc import Iterable, Mapping
from typing import BinaryIO

import numpy as np

from ..core.conventions import Array
from .exr import MAGIC, ROWS_OF_CHUNK, compression_of, packed
from .exr_part import Part

_VERSION = struct.pack("<I", 2 | 1 << 12)
"""Version 2, with several parts."""

_TEXELS_AT_ONCE = 1 << 20
"""Texels that are packed at a time, in memory of their own."""


class PartsInTurn:
    """A file that is being written; its bytes are those that `exr.write_parts` would write.

    Parameters
    ----------
    stream : BinaryIO
        The file, at its start.
    shapes : mapping of str to (int, int)
        Height and width of every part by its name, in order; each has the channels R, G and B.
    attribute, text : str
        Name of an attribute of the first part, and a text of its final length.
    """

    def __init__(
        self, stream: BinaryIO, shapes: Mapping[str, tuple[int, int]], attribute: str, text: str
    ) -> None:
        self._stream, self._attribute, self._text = stream, attribute, text
        self._shapes, self._first = shapes, next(iter(shapes))
        self._largest = np.max(list(shapes.values()), axis=0).tolist()
        self._headers: list[dict[bytes, bytes]] = []
        self._offsets: list[int] = []
        # A part of one texel has a header of the same length
        texel = np.zeros((1, 1, 3), np.float32)
        headers = [self._whole(name, self._packed(name, texel)[0]) for name in shapes]
        chunks = sum(_chunk_count(*shape) for shape in shapes.values())
        stream.seek(len(_headers_as_bytes(headers)) + 8 * chunks)

    def add(self, name: str, pixels: Array) -> None:
        """Write the next part.

        Parameters
        ----------
        name : str
        pixels : ndarray, shape (height, width, 3), float32 or float16
            Row 0 at the bottom.

        Raises
        ------
        OSError
            The disk is full.
        """
        height, width = self._shapes[name]
        together = _rows_of_chunk(width)
        rows = max(_TEXELS_AT_ONCE // width // together, 1) * together
        for top in range(0, height, rows):
            header, chunks = self._packed(name, pixels[max(height - top - rows, 0) : height - top], top)
            self._write(chunks)
        self._headers.append(self._whole(name, header))

    def add_black(self, name: str) -> None:
        """Write the next part, of half floats that are all 0.

        Parameters
        ----------
        name : str

        Raises
        ------
        OSError
            The disk is full.
        """
        height, width = self._shapes[name]
        together = _rows_of_chunk(width)
        # Chunks of as many rows are alike but for the number of the first row, which they begin with
        alike = {
            rows: self._packed(name, np.zeros((rows, width, 3), np.float16))
            for rows in {min(together, height), height % together} - {0}
        }
        for top in range(0, height, together):
            header, (chunk,) = alike[min(together, height - top)]
            self._write([struct.pack("<i", top) + chunk[4:]])
        self._headers.append(self._whole(name, header))

    def finish(self, text: str) -> None:
        """Write the headers before all parts, when these are written.

        Parameters
        ----------
        text : str
            The first part's attribute, of the announced length.

        Raises
        ------
        OSError
            The disk is full.
        """
        encoded = text.encode()
        self._headers[0][self._attribute.encode()] = b"string\0" + struct.pack("<i", len(encoded)) + encoded
        self._stream.seek(0)
        self._stream.write(_headers_as_bytes(self._headers))
        self._stream.write(np.array(self._offsets, "<u8").tobytes())

    def _write(self, chunks: Iterable[bytes | memoryview]) -> None:
        for chunk in chunks:
            self._offsets.append(self._stream.tell())
            self._stream.write(struct.pack("<i", len(self._headers)))
            self._stream.write(chunk)

    def _whole(self, name: str, header: dict[bytes, bytes]) -> dict[bytes, bytes]:
        """The header of a part, given that of some of its rows."""
        height, width = self._shapes[name]
        return header | {
            b"dataWindow": b"box2i\0" + struct.pack("<5i", 16, 0, 0, width - 1, height - 1),
            b"chunkCount": b"int\0" + struct.pack("<2i", 4, _chunk_count(height, width)),
        }

    def _packed(self, name: str, pixels: Array, top: int = 0) -> tuple[dict[bytes, bytes], list[memoryview]]:
        """Attributes of some rows by name, each with its type and size before it, and their chunks."""
        attributes = {self._attribute: self._text} if name == self._first else {}
        file = packed(Part(name, {"RGB": pixels}, attributes), self._largest, top)
        header, at = {}, len(MAGIC + _VERSION)
        while file[at]:
            end_of_name = file.index(0, at)
            end_of_type = file.index(0, end_of_name + 1)
            end = end_of_type + 5 + int.from_bytes(file[end_of_type + 1 : end_of_type + 5], "little")
            header[file[at:end_of_name]] = file[end_of_name + 1 : end]
            at = end
        count = _chunk_count(*pixels.shape[:2])
        starts = [*struct.unpack_from(f"<{count}Q", file, at + 1), len(file)]
        return header, [memoryview(file)[start:end] for start, end in itertools.pairwise(starts)]


def _rows_of_chunk(width: int) -> int:
    return ROWS_OF_CHUNK[compression_of(width)]


def _chunk_count(height: int, width: int) -> int:
    return -(-height // _rows_of_chunk(width))


def _headers_as_bytes(headers: list[dict[bytes, bytes]]) -> bytes:
    """Everything before the offsets of chunks; attributes are in the order of their names."""
    ended = [b"".join(name + b"\0" + header[name] for name in sorted(header)) + b"\0" for header in headers]
    return MAGIC + _VERSION + b"".join(ended) + b"\0"
