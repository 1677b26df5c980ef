"""Choices that do not depend on rounding: among values that only rounding tells apart, the first wins."""

import numpy as np

from .conventions import Array, Indices

TIE = 1e-9
"""Difference, relative to the largest magnitude or to 1, below which values are equal but for rounding."""


def first_greatest(values: Array) -> int:
    """Index of the greatest of some values.

    Parameters
    ----------
    values : ndarray, any shape
        At least one of them finite; none NaN.

    Returns
    -------
    int
        Index of the first value, in the order of memory, that is the greatest but for rounding.
    """
    return int(np.argmax(values >= np.max(values) - _margin(values)))


def greatest_first(values: Array) -> Indices:
    """Order values from the greatest to the least.

    Parameters
    ----------
    values : ndarray, shape (n,)
        Finite.

    Returns
    -------
    ndarray, shape (n,)
        Numbers of the values; values that are equal but for rounding keep their order.
    """
    order = np.argsort(-values, kind="stable")
    steps = np.diff(values[order], prepend=values[order[:1]]) < -_margin(values)
    ordered: Indices = order[np.lexsort((order, np.cumsum(steps)))]
    return ordered


def _margin(values: Array) -> float:
    return TIE * float(np.max(np.abs(values), where=np.isfinite(values), initial=0.0))
