"""The curve between radiance and the numbers in a picture's file."""

import numpy as np

from .conventions import Array, ArrayLike


def linear_from_srgb(encoded: ArrayLike) -> Array:
    """Undo the curve that pictures of 8 or 16 bits are stored with.

    Parameters
    ----------
    encoded : array_like, any shape
        In [0, 1].

    Returns
    -------
    ndarray, shape of `encoded`, float64
        In [0, 1], proportional to radiance.

    Notes
    -----
    IEC 61966-2-1: a power of 2.4 with a straight piece near black.
    """
    encoded = np.asarray(encoded, dtype=np.float64)
    power = ((encoded + 0.055) / 1.055) ** 2.4
    linear: Array = np.where(encoded <= 0.04045, encoded / 12.92, power)
    return linear
