"""Numbers as colours."""

import numpy as np

from ..conventions import Array, ArrayLike


def heat(number: ArrayLike) -> Array:
    """From black over red and yellow to white, like heated iron, and always brighter.

    Parameters
    ----------
    number : array_like, any shape
        From 0, black, to 1, white; values outside are clipped.

    Returns
    -------
    ndarray, shape (..., 3), float64
        As `display.displayed` gives it.

    Notes
    -----
    GLSL twin: gpu_shaders/lib/false_colour_lib.glsl `heat`.
    """
    colour: Array = np.clip(3.0 * np.asarray(number, np.float64)[..., None] - np.arange(3.0), 0.0, 1.0)
    return colour
