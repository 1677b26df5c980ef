"""Radiance in four bytes: colours of gamma 2.2 and a divisor, as Babylon.js and glTF's lights take it."""

import numpy as np

from .conventions import Array

GAMMA = 2.2

LARGEST = 255.0
"""The largest value: a whole colour over the smallest divisor."""

DARKEST = 1e-2
"""Radiance below which rounding takes more than 1 % of a value in the median, and 3 % of a thousandth."""

TRIED = 24
"""Divisors that are tried for each texel, from the largest on."""

FLOOR = 1e-3
"""Value below which errors count by this, not by themselves."""


def rgbd_from_radiance(radiance: Array) -> Array:
    """Encode radiance.

    Parameters
    ----------
    radiance : ndarray, shape (..., 3)
        From 0 to `LARGEST`.

    Returns
    -------
    ndarray, shape (..., 4), uint8
        Red, green and blue c and a divisor d from 1 on, for radiance (c / 255)^2.2 / (d / 255).

    Notes
    -----
    Babylon.js takes the largest divisor that leaves colours within 1. Among it and those below it, this is
    the one whose rounding changes the three colours least, in shares of themselves.
    """
    brightest = np.maximum(radiance.max(axis=-1), 1.0)
    largest = np.floor(LARGEST / brightest + 1e-9)
    best = np.full(largest.shape, np.inf)
    encoded = np.empty((*largest.shape, 4), np.uint8)
    for less in range(TRIED):
        divisor = np.maximum(largest - less, 1.0)[..., None]
        colour = np.rint(255.0 * np.minimum(radiance * divisor / 255.0, 1.0) ** (1.0 / GAMMA))
        error = (_radiance(colour, divisor) - radiance) / np.maximum(radiance, FLOOR)
        squared = np.sum(error**2, axis=-1)
        closer = squared < best
        best = np.where(closer, squared, best)
        encoded[closer] = np.concatenate([colour, divisor], axis=-1)[closer]
    return encoded


def _radiance(colour: Array, divisor: Array) -> Array:
    decoded: Array = (colour / 255.0) ** GAMMA / (divisor / 255.0)
    return decoded
