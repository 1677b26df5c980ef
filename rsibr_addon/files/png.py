"""PNG in memory, for files that hold pictures."""

import struct
import zlib

import numpy as np

from ..core.conventions import Array

_SUB = 1
"""Each byte as its difference from the same of the texel before, which packs better."""


def png_of(rgba: Array) -> bytes:
    """A PNG file of 8 bits.

    Parameters
    ----------
    rgba : ndarray, shape (height, width, 4), uint8
        Row 0 on top.
    """
    height, width = rgba.shape[:2]
    rows = np.empty((height, 1 + 4 * width), np.uint8)
    rows[:, 0] = _SUB
    rows[:, 1:] = np.diff(rgba, axis=1, prepend=np.uint8(0)).reshape(height, -1)
    header = struct.pack(">2I5B", width, height, 8, 6, 0, 0, 0)
    chunks = ((b"IHDR", header), (b"IDAT", zlib.compress(rows.tobytes(), 9)), (b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(_chunk(*chunk) for chunk in chunks)


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
