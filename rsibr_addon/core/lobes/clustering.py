"""Matching of lobes from one elevation to the next: [Kautz2000] section 3.3, Figure 5."""

import numpy as np

from ..conventions import Array, Indices
from ..ties import first_greatest


def clustered(offsets: Array) -> Indices:
    """Order the lobes of every elevation so that each sequence stays together.

    Parameters
    ----------
    offsets : ndarray, shape (S, L, 2)
        Offsets of the lobes' axes, in any order at each of S elevations.

    Returns
    -------
    ndarray, shape (S, L)
        Number of the lobe of each elevation that belongs to each sequence.

    Notes
    -----
    From the last elevation, nearest to the normal, towards grazing: the nearest pair of a sequence and a lobe
    is matched first, then the nearest of the others, and so on.
    """
    slices, lobes = offsets.shape[:2]
    order = np.tile(np.arange(lobes), (slices, 1))
    for s in range(slices - 2, -1, -1):
        before = offsets[s + 1, order[s + 1]]
        distance = np.linalg.norm(before[:, None] - offsets[s], axis=-1)
        for _ in range(lobes):
            sequence, lobe = np.unravel_index(first_greatest(-distance), distance.shape)
            order[s, sequence] = lobe
            distance[sequence], distance[:, lobe] = np.inf, np.inf
    return order
