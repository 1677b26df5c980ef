"""Whether floats of 16 bits can hold light: neither too bright for them nor too dark."""

from collections.abc import Sequence

import numpy as np

from .conventions import Array

PRECISION = 1e-3
"""Relative error that is allowed; 11 significant bits keep half of it."""

DARKNESS = 1e-3
"""Of the mean: darker values may err as much as one of this."""


def half_holds(maps: Sequence[Array]) -> bool:
    """Whether half floats can hold all maps of a texture.

    Parameters
    ----------
    maps : sequence of ndarray
        Of any shapes, finite.

    Returns
    -------
    bool
        Rounding changes no value by more than `PRECISION` of itself, or of `DARKNESS` of the mean magnitude:
        from 65520 on half floats are infinite, below 6e-5 they get coarser, and below 3e-8 they are 0.
    """
    count = sum(pixels.size for pixels in maps)
    mean = sum(float(np.sum(np.abs(pixels), dtype=np.float64)) for pixels in maps) / count
    return all(_held(pixels, DARKNESS * mean) for pixels in maps)


def _held(pixels: Array, floor: float) -> bool:
    # The largest, 65504, is what suns are clipped to: with the last bit of a mean it may be a little more
    with np.errstate(over="ignore"):
        error = np.abs(pixels.astype(np.float16).astype(np.float32) - pixels)
    return bool(np.all(error <= PRECISION * np.maximum(np.abs(pixels), floor)))
