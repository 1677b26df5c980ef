"""Which kernels a family needs: others hardly count, and each costs shaders a lookup for every lobe.

A lookup is saved between two widths where neither needs it. So a kernel is needed by one run of widths, which
gets shorter from its ends, each time by the width that raises the squared error least.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..conventions import Array

Equations = tuple[Array, Array]
"""Normal equations of one elevation for J lobes of K kernels: system, shape (J K, J K), and right sides,
shape (J K, C).
"""


def thinned(
    rows: Sequence[Sequence[Equations]], errors: Array, most: float, kernels: int
) -> NDArray[np.bool_]:
    """Choose the kernels that count.

    Parameters
    ----------
    rows : sequence of sequence of Equations
        Of each width, and of each of its elevations.
    errors : ndarray, shape (A,)
        Squared error of each width, with all kernels, summed over its elevations.
    most : float
        By how much of that it may rise.
    kernels : int
        Their number K.

    Returns
    -------
    ndarray of bool, shape (A, K)
        True for what is kept.
    """
    kept = np.ones((len(rows), kernels), dtype=bool)
    rises = np.array([_rises(row, each) for row, each in zip(rows, kept, strict=True)])
    risen = np.zeros(len(rows))
    while True:
        without = np.pad(~kept, ((1, 1), (0, 0)), constant_values=True)
        ends = kept & (without[:-2] | without[2:])
        shares = np.where(ends, rises, np.inf) / errors[:, None]
        shares[risen[:, None] / errors[:, None] + shares > most] = np.inf
        width, kernel = divmod(int(np.argmin(shares)), kernels)
        if np.isinf(shares[width, kernel]):
            return kept
        risen[width] += rises[width, kernel]
        kept[width, kernel] = False
        rises[width] = _rises(rows[width], kept[width])


def solution(equations: Equations, kept: NDArray[np.bool_]) -> Array:
    """The unknowns, shape (J K, C), where those of kernels that are not kept are 0.

    Parameters
    ----------
    equations : Equations
    kept : ndarray of bool, shape (K,)
    """
    system, right = equations
    used = np.tile(kept, len(right) // len(kept))
    found = np.zeros_like(right)
    found[used] = np.linalg.solve(system[np.ix_(used, used)], right[used])
    return found


def _rises(row: Sequence[Equations], kept: NDArray[np.bool_]) -> Array:
    """What each kernel that is kept takes from the squared error, shape (K,)."""
    rises, count = np.zeros(len(kept)), np.count_nonzero(kept)
    for system, right in row:
        lobes = len(right) // len(kept)
        used = np.tile(kept, lobes)
        inverse = np.linalg.inv(system[np.ix_(used, used)])
        found = (inverse @ right[used]).reshape(lobes, count, -1).swapaxes(0, 1)
        own = np.einsum("ikjk->kij", inverse.reshape(lobes, count, lobes, count))
        rises[kept] += np.sum(found * np.linalg.solve(own, found), axis=(1, 2))
    return rises
