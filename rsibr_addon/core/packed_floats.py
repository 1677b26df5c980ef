"""Radiance in 32 bits: small floats without a sign, as graphics interfaces pack them."""

import numpy as np

from .conventions import Array, Indices

LARGEST = 64512.0
"""The largest value that all three channels have; blue ends there, red and green at 65024."""

DARKEST = 2.0**-14
"""The least value of full precision; steps between darker ones are as wide."""


def packed_r11g11b10(radiance: Array) -> Indices:
    """Radiance as R11F_G11F_B10F.

    Parameters
    ----------
    radiance : ndarray, shape (..., 3)
        From 0 to `LARGEST`.

    Returns
    -------
    ndarray, shape (...), uint32
        Red in the lowest 11 bits, then green, and blue in the highest 10: 5 bits of exponent, and 6 bits of
        mantissa, blue 5. Rounded to the nearest: red and green err by 1/128 of themselves at most, blue by
        1/64.

    Notes
    -----
    OpenGL 4.6, sections 2.3.4.3 and 2.3.4.4. A half float has the same exponent and more mantissa, so that
    its bits, rounded, are the small float's.
    """
    with np.errstate(under="ignore"):
        half = radiance.astype(np.float16).view(np.uint16).astype(np.uint32)
    red, green = ((half[..., channel] + 0x8) >> 4 for channel in (0, 1))
    packed: Indices = red | green << 11 | (half[..., 2] + 0x10) >> 5 << 22
    return packed
