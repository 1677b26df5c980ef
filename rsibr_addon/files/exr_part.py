"""A picture of an OpenEXR file, and the windows that it has."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.lib.stride_tricks import as_strided

from ..core.conventions import Array, Indices
from ..core.errors import InputFileError
from .memory import check_memory

FEWEST_STORED = 1000
"""Number of pixels in a picture of which at least one must be stored."""

BYTES_OF_SAMPLE = 8
"""Bytes of memory for each number of a channel: a float, and as much again for the picture made of it."""


@dataclass(frozen=True)
class Part:
    """One picture of a file.

    Attributes
    ----------
    name : str
        Unique in its file; may be empty when it is alone.
    channels : dict of str to ndarray, shape (height, width)
        Pixels by channel name, float32, float16 or uint32, row 0 at the bottom. On writing, "RGB" and "RGBA"
        stand for channels side by side, shape (height, width, 3 or 4).
    attributes : dict of str to object
        The part's header as the package gives it; on writing, only attributes of our own.
    """

    name: str
    channels: dict[str, Array]
    attributes: dict[str, Any] = field(default_factory=dict)

    def side_by_side(self, names: Iterable[str]) -> Array:
        """Channels of one type, as one array, shape (height, width, names).

        What lies so in memory is not copied, as R, G and B that were read and nothing beside them.
        """
        chosen = [self.channels[name] for name in names]
        first, (height, width) = chosen[0], chosen[0].shape
        size, count = first.itemsize, len(chosen)
        strides = (width * count * size, count * size)
        start = first.ctypes.data
        if all(
            channel.dtype == first.dtype
            and channel.strides == strides
            and channel.ctypes.data == start + number * size
            for number, channel in enumerate(chosen)
        ):
            return as_strided(first, (height, width, count), (*strides, size))
        return np.stack(chosen, axis=-1)


def window_size(window: tuple[Indices, Indices]) -> tuple[int, int]:
    """Width and height of a window.

    Parameters
    ----------
    window : (ndarray, ndarray)
        Its corners, both within it, as a header has them.

    Returns
    -------
    int, int
    """
    low, high = window
    return int(high[0]) - int(low[0]) + 1, int(high[1]) - int(low[1]) + 1


def in_display_window(path: str | Path, part: Part) -> Part:
    """The whole picture of a part that stores only a window of it, or more than it.

    Parameters
    ----------
    path : str or Path
        The file's path, for messages.
    part : Part
        As read.

    Returns
    -------
    Part
        With the pixels of its display window; those that the file does not store are 0.

    Raises
    ------
    InputFileError
        It stores none of them, or hardly any.
    RangeError
        The picture is too large for this machine's memory.
    """
    low, high = (np.asarray(corner, dtype=np.int64) for corner in part.attributes["dataWindow"])
    first, last = (np.asarray(corner, dtype=np.int64) for corner in part.attributes["displayWindow"])
    if np.array_equal(low, first) and np.array_equal(high, last):
        return part
    start, end = np.maximum(low, first), np.minimum(high, last) + 1
    width, height = window_size(part.attributes["displayWindow"])
    if np.any(end <= start) or np.prod(end - start) * FEWEST_STORED < width * height:
        raise InputFileError(
            f"{path} is black, as its data window lies beside its display window, or is a speck in it: "
            f"save it again, cropped."
        )
    check_memory(BYTES_OF_SAMPLE * width * height * len(part.channels), str(path), (width, height))
    channels = {}
    for name, pixels in part.channels.items():
        picture = np.zeros((height, width), pixels.dtype)
        # Windows count rows from the top
        picture[::-1][_between(start - first, end - first)] = pixels[::-1][_between(start - low, end - low)]
        channels[name] = picture
    return Part(part.name, channels, part.attributes)


def _between(start: Indices, end: Indices) -> tuple[slice, slice]:
    """Rows and columns from (x, y) `start` up to, not including, `end`."""
    return slice(start[1], end[1]), slice(start[0], end[0])
