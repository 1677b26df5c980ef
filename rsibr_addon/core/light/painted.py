"""Painted environments: white paint becomes light. [Miller1984] section 5.3."""

import numpy as np

from ..conventions import Array, ArrayLike
from ..errors import RangeError
from .luminance import luminance


def lift_whites(picture: ArrayLike, white: ArrayLike, knee: float) -> Array:
    """Make the whites of a picture as bright as lamps, and keep darker colours.

    Parameters
    ----------
    picture : array_like, shape (..., 3)
        Linear Rec. 709, in [0, 1].
    white : array_like, shape (3,) or ()
        Radiance that white, (1, 1, 1), shall have; at least 1.
    knee : float
        Luminance, in [0, 1), up to which nothing changes.

    Returns
    -------
    ndarray, shape (..., 3), float64

    Raises
    ------
    RangeError
        `white` is less than 1 or infinite, or `knee` is outside [0, 1).

    Notes
    -----
    Each colour is multiplied by white ** (t * t), where t grows from 0 at the knee to 1 with luminance. So a
    ramp of one hue stays a ramp, with a continuous slope. Equal steps of t near white are equal steps of
    exposure, and bright colours that are not white, such as a yellow wall, change less.
    """
    picture, white = np.asarray(picture, dtype=np.float64), np.asarray(white, dtype=np.float64)
    if not (np.all(np.isfinite(white)) and np.all(white >= 1.0)):
        raise RangeError("White is lifted to a radiance of 1 or more: give such a number, or three.")
    if not 0.0 <= knee < 1.0:
        raise RangeError(
            f"A knee of {knee:g} lies outside the picture's values: choose one from 0 to below 1."
        )
    lifted = np.clip((luminance(picture) - knee) / (1.0 - knee), 0.0, 1.0)
    radiance: Array = picture * white ** np.square(lifted)[..., None]
    return radiance
