"""The curve between radiance and the numbers in a picture's file."""

import numpy as np

from ..conventions import Array, ArrayLike


def linear_from_srgb(encoded: ArrayLike) -> Array:
    """Undo the curve of stored pictures with 8 or 16 bits.

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


def srgb_from_linear(linear: ArrayLike) -> Array:
    """The inverse of `linear_from_srgb`; values outside [0, 1] become 0 or 1.

    Parameters
    ----------
    linear : array_like, any shape
        Proportional to radiance, 1 for white.

    Returns
    -------
    ndarray, shape of `linear`, float64
        In [0, 1], as stored in pictures.
    """
    linear = np.clip(np.asarray(linear, dtype=np.float64), 0.0, 1.0)
    encoded: Array = np.where(
        linear <= 0.04045 / 12.92, 12.92 * linear, 1.055 * linear ** (1.0 / 2.4) - 0.055
    )
    return encoded
