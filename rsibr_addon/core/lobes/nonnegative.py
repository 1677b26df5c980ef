"""Least squares whose unknowns may not be negative."""

import numpy as np
from numpy.typing import NDArray

from ..conventions import Array

_TOLERANCE = 1e-10


def nonnegative_inverse(system: Array, right: Array) -> Array:
    """The matrix that solves a least-squares problem with non-negative unknowns.

    Parameters
    ----------
    system : ndarray, shape (N, N)
        Symmetric and positive definite.
    right : ndarray, shape (N,)

    Returns
    -------
    ndarray, shape (N, N)
        Inverse of the part of `system` whose unknowns are positive, and 0 elsewhere: times `right` it is the
        x of least x.system x / 2 - x.right with all x >= 0.

    Notes
    -----
    [Lawson1974] chapter 23, on the normal equations as in [Bro1997]: unknowns become positive one by one, the
    steepest first, and become 0 again where a step would make them negative.
    """
    scale = _TOLERANCE * max(float(np.max(np.abs(right))), np.finfo(np.float64).tiny)
    positive = np.zeros(len(right), dtype=bool)
    x: Array = np.zeros(len(right))
    for _ in range(3 * len(right)):
        slope = np.where(positive, -np.inf, right - system @ x)
        steepest = int(np.argmax(slope))
        if slope[steepest] <= scale:
            break
        positive[steepest] = True
        x = _bounded(system, right, positive, x)
    inverse = np.zeros_like(system)
    chosen = np.flatnonzero(positive)
    inverse[np.ix_(chosen, chosen)] = np.linalg.inv(system[np.ix_(chosen, chosen)])
    return inverse


def _bounded(system: Array, right: Array, positive: NDArray[np.bool_], x: Array) -> Array:
    """The least squares of the positive unknowns, whose set shrinks, in place, until all of them are."""
    while True:
        trial = np.zeros_like(x)
        chosen = np.flatnonzero(positive)
        trial[chosen] = np.linalg.solve(system[np.ix_(chosen, chosen)], right[chosen])
        below = positive & (trial <= 0.0)
        if not np.any(below):
            return trial
        shares = np.full(len(x), np.inf)
        shares[below] = x[below] / (x[below] - trial[below])
        x = x + shares.min() * (trial - x)
        # Rounding may leave a little of the unknown that ends the step
        positive &= (x > 0.0) & (shares > shares.min())
        x[~positive] = 0.0
