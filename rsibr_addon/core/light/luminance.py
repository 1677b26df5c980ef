"""Luminance of Rec. 709."""

import numpy as np

from ..conventions import Array, ArrayLike

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
"""Weights of Rec. 709's red, green and blue in luminance."""


def luminance(radiance: ArrayLike) -> Array:
    """Luminance of colours.

    Parameters
    ----------
    radiance : array_like, shape (..., 3)

    Returns
    -------
    ndarray, shape (...), float64
    """
    weighted: Array = np.asarray(radiance, np.float64) @ LUMINANCE
    return weighted
