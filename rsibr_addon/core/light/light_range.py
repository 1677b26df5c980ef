"""The range of a picture's values."""

from dataclasses import dataclass

import numpy as np

from ..conventions import Array

ROWS = 64
"""Rows of a picture that are examined at once."""


@dataclass(frozen=True)
class LightRange:
    """The range of a picture's values, and counts of special ones.

    Attributes
    ----------
    peak, dark_end : float
        The greatest finite value, and the least above 0; 0 where there is none.
    mean : float
        Mean of the finite values from 0 on, over the picture's pixels.
    black, negative, infinite, undefined : int
        Values that are 0, below 0, infinite, and NaN.
    """

    peak: float
    dark_end: float
    mean: float
    black: int
    negative: int
    infinite: int
    undefined: int


def light_range(picture: Array) -> LightRange:
    """Examine a picture's values.

    Parameters
    ----------
    picture : ndarray, shape (height, width, channels)
        Radiance.
    """
    peak, dark_end, total, count = 0.0, np.inf, 0.0, 0
    kinds = np.zeros(4, dtype=np.int64)
    for first in range(0, len(picture), ROWS):
        rows = picture[first : first + ROWS]
        positive = np.isfinite(rows) & (rows > 0.0)
        some = [rows == 0.0, (rows < 0.0) & (rows > -np.inf), np.isinf(rows), np.isnan(rows)]
        kinds += [np.count_nonzero(kind) for kind in some]
        peak = max(peak, float(np.max(rows, where=positive, initial=0.0)))
        dark_end = min(dark_end, float(np.min(rows, where=positive, initial=np.inf)))
        total += float(np.sum(rows, where=positive, dtype=np.float64))
        count += int(np.count_nonzero(positive))
    black, negative, infinite, undefined = kinds.tolist()
    mean = total / max(count + black, 1)
    return LightRange(peak, dark_end if count else 0.0, mean, black, negative, infinite, undefined)
