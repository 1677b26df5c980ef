"""Whether floats of 16 bits can hold light: neither too bright for them nor too dark."""

from collections.abc import Sequence

import numpy as np

from .conventions import Array

LARGEST = 65504.0
"""The largest half float."""

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
        No value is beyond `LARGEST`, and rounding changes none by more than `PRECISION` of itself, or of
        `DARKNESS` of the mean magnitude: below 6e-5 half floats get coarser, and below 3e-8 they are 0.
    """
    count = sum(pixels.size for pixels in maps)
    mean = sum(float(np.sum(np.abs(pixels), dtype=np.float64)) for pixels in maps) / count
    return all(_held(pixels, DARKNESS * mean) for pixels in maps)


def _held(pixels: Array, floor: float) -> bool:
    magnitude = np.abs(pixels)
    if magnitude.max() > LARGEST:
        return False
    error = np.abs(pixels.astype(np.float16).astype(np.float32) - pixels)
    return bool(np.all(error <= PRECISION * np.maximum(magnitude, floor)))
