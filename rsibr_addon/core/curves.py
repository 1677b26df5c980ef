"""Curves over the cosine between normal and view, as texts."""

import numpy as np

from .conventions import Array
from .errors import RangeError


def curve_points(text: str) -> Array:
    """The points of a curve.

    Parameters
    ----------
    text : str
        ``cosine:value/cosine:value``, in the order of the cosines, which are in [0, 1]; values are 0 to 1e6.

    Returns
    -------
    ndarray, shape (N, 2)

    Raises
    ------
    RangeError
        It is no such text.
    """
    try:
        points = np.array([[float(number) for number in point.split(":")] for point in text.split("/")])
        cosines, values = points.T
    except ValueError:
        raise RangeError(
            f'a curve cannot be "{text}": write COSINE:VALUE/COSINE:VALUE, as in 0:1/0.5:0.3/1:0.04.'
        ) from None
    rising = np.all(np.diff(cosines) > 0.0)
    if not (rising and 0.0 <= cosines[0] <= cosines[-1] <= 1.0 and np.all((values >= 0.0) & (values <= 1e6))):
        raise RangeError("a curve's cosines must rise from 0 to 1 at most, its values be from 0 to 1e+06.")
    return points


def on_curve(text: str, cosine: Array) -> Array:
    """A curve's values, straight between its points and even beyond them.

    Parameters
    ----------
    text : str
        See `curve_points`.
    cosine : ndarray, shape (N,)

    Returns
    -------
    ndarray, shape (N,), float64
    """
    points = curve_points(text)
    value: Array = np.interp(cosine, points[:, 0], points[:, 1])
    return value
