"""Whether floats of 16 bits can hold light that may be very bright or very dark."""

from collections.abc import Sequence

import numpy as np

from .conventions import Array

PRECISION = 1e-3
"""Allowed relative error; 11 significant bits keep half of it."""

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
    mean = sum(float(np.sum(np.abs(pixels), dtype=np.float64)) for pixels in maps) / count
    return all(_held(pixels, DARKNESS * mean) for pixels in maps)


def half_states(pixels: Array) -> bool:
    """Whether half floats hold every value of a map to the last bit.

    They do of pictures that were half floats, and mostly of Radiance HDR, whose mantissas have 8 bits.

    Parameters
    ----------
    pixels : ndarray, shape (height, ...), float32
        Finite.
    """
    with np.errstate(over="ignore"):
        # Row by row, because the first is enough where they do not
        return all(np.array_equal(row.astype(np.float16), row) for row in pixels)


def _held(pixels: Array, floor: float) -> bool:
    # Suns are clipped to the largest, 65504: with the last bit of a mean a value may be a little above
    with np.errstate(over="ignore"):
        error = np.abs(pixels.astype(np.float16).astype(np.float32) - pixels)
    return bool(np.all(error <= PRECISION * np.maximum(np.abs(pixels), floor)))
