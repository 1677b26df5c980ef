"""Which kernels of which lobes a family needs: others hardly count, and each costs shaders a lookup.

A lookup is saved between two widths where neither needs it. So what a lobe needs of a kernel is one run of
widths, which gets shorter from its ends, each time by the width that raises the squared error least.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..conventions import Array

Equations = tuple[Array, Array]
"""Normal equations of one elevation: system, shape (P, P), and right sides, shape (P, C)."""


def thinned(rows: Sequence[Sequence[Equations]], errors: Array, most: float) -> NDArray[np.bool_]:
    """Choose the unknowns that count.

    Parameters
    ----------
    rows : sequence of sequence of Equations
        Of each width, and of each of its elevations.
    errors : ndarray, shape (A,)
        Squared error of each width, with all unknowns, summed over its elevations.
    most : float
        By how much of that it may rise.

    Returns
    -------
    ndarray of bool, shape (A, P)
        True for what is kept.
    """
    count = len(rows[0][0][1])
    kept = np.ones((len(rows), count), dtype=bool)
    rises = np.array([_rises(row, np.ones(count, dtype=bool)) for row in rows])
    risen = np.zeros(len(rows))
    while True:
        without = np.pad(~kept, ((1, 1), (0, 0)), constant_values=True)
        ends = kept & (without[:-2] | without[2:])
        shares = np.where(ends, rises, np.inf) / errors[:, None]
        shares[risen[:, None] / errors[:, None] + shares > most] = np.inf
        width, unknown = divmod(int(np.argmin(shares)), count)
        if np.isinf(shares[width, unknown]):
            return kept
        risen[width] += rises[width, unknown]
        kept[width, unknown] = False
        rises[width] = _rises(rows[width], kept[width])


def solution(equations: Equations, kept: NDArray[np.bool_]) -> Array:
    """The unknowns, shape (P, C), where those that are not kept are 0.

    Parameters
    ----------
    equations : Equations
    kept : ndarray of bool, shape (P,)
    """
    system, right = equations
    found = np.zeros_like(right)
    found[kept] = np.linalg.solve(system[np.ix_(kept, kept)], right[kept])
    return found


def _rises(row: Sequence[Equations], kept: NDArray[np.bool_]) -> Array:
    """What each unknown that is kept takes from the squared error, shape (P,)."""
    rises = np.zeros(len(kept))
    for system, right in row:
        inverse = np.linalg.inv(system[np.ix_(kept, kept)])
        rises[kept] += np.sum((inverse @ right[kept]) ** 2, axis=1) / inverse.diagonal()
    return rises
