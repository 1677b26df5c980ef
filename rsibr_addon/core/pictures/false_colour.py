"""Numbers as colours."""

import numpy as np

from ..conventions import Array, ArrayLike


def heat(number: ArrayLike) -> Array:
    """Black, red, yellow, white: as iron that is heated, and ever brighter.

    Parameters
    ----------
    number : array_like, any shape
        From 0, black, to 1, white; outside of it as at its ends.

    Returns
    -------
    ndarray, shape (..., 3), float64
        In [0, 1], as sent to the display.

    Notes
    -----
    GLSL twin: gpu_shaders/lib/false_colour_lib.glsl `heat`.
    """
    colour: Array = np.clip(3.0 * np.asarray(number, np.float64)[..., None] - np.arange(3.0), 0.0, 1.0)
    return colour
