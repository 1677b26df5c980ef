"""Decisions that rounding does not take: of what is equal but for that, the first is chosen."""

import numpy as np

from .conventions import Array, Indices

TIE = 1e-9
"""What differs by less than this, of the largest magnitude or of a unit, is equal but for rounding."""


def first_greatest(values: Array) -> int:
    """Where the greatest of some values is.

    Parameters
    ----------
    values : ndarray, any shape
        At least one of them finite; none NaN.

    Returns
    -------
    int
        The first, in the order of memory, that is the greatest but for rounding.
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
        Their numbers; those whose values are equal but for rounding are in their own order.
    """
    order = np.argsort(-values, kind="stable")
    steps = np.diff(values[order], prepend=values[order[:1]]) < -_margin(values)
    ordered: Indices = order[np.lexsort((order, np.cumsum(steps)))]
    return ordered


def _margin(values: Array) -> float:
    return TIE * float(np.max(np.abs(values), where=np.isfinite(values), initial=0.0))
