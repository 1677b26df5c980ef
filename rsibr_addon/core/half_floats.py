"""Whether floats of 16 bits can hold light that may be very bright or very dark."""

from collections.abc import Iterator, Sequence
from itertools import chain

import numpy as np

from .conventions import Array

PRECISION = 1e-3
"""Allowed relative error; 11 significant bits keep half of it."""

VALUES_AT_ONCE = 1 << 16
"""Values that are looked at at a time: a whole environment's would take four times its memory."""

DARKNESS = 1e-3
"""Share of the mean; darker values may have the absolute error of a value of this size."""


def half_holds(maps: Sequence[Array]) -> bool:
    """Whether half floats can hold all maps of a texture.

    Parameters
    ----------
    maps : sequence of ndarray
        Arrays of any shapes, finite.

    Returns
    -------
    bool
        Rounding changes no value by more than `PRECISION` of itself, or of `DARKNESS` times the mean
        magnitude. From 65520 on half floats are infinite, below 6e-5 they get coarser, and below 3e-8 they
        are 0.
    """
    count = sum(pixels.size for pixels in maps)
    rows = list(chain.from_iterable(map(_pieces, maps)))
    mean = sum(float(np.sum(np.abs(some), dtype=np.float64)) for some in rows) / count
    return all(_held(some, DARKNESS * mean) for some in rows)


def half_states(pixels: Array) -> bool:
    """Whether half floats hold every value of a map to the last bit.

    They do of pictures that were half floats, and mostly of Radiance HDR, whose mantissas have 8 bits.

    Parameters
    ----------
    pixels : ndarray, shape (height, ...), float32
        Finite.
    """
    with np.errstate(over="ignore"):
        # Piece by piece, because the first is enough where they do not
        return all(np.array_equal(some.astype(np.float16), some) for some in _pieces(pixels))


def _pieces(pixels: Array) -> Iterator[Array]:
    """Rows of a map that fit into a processor's cache together, with what is computed of them."""
    step = max(1, VALUES_AT_ONCE * len(pixels) // max(1, pixels.size))
    return (pixels[start : start + step] for start in range(0, len(pixels), step))


def _held(pixels: Array, floor: float) -> bool:
    # Suns are clipped to the largest, 65504: with the last bit of a mean a value may be a little above
    with np.errstate(over="ignore"):
        error = np.abs(pixels.astype(np.float16).astype(np.float32) - pixels)
    return bool(np.all(error <= PRECISION * np.maximum(np.abs(pixels), floor)))
