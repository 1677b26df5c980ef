"""A mesh of fewer triangles, for what is seen too coarsely to tell it from the whole."""

import numpy as np

from ..conventions import Array, Indices

KEPT_AREA = 0.98
"""Least share of the area that a coarser mesh must have: wires and hair thinner than a cell would vanish."""


def coarser_mesh(positions: Array, triangles: Indices, cell: float) -> tuple[Array, Indices]:
    """Join the vertices of each cell of a grid, unless the surface is finer than that.

    Parameters
    ----------
    positions : ndarray, shape (V, 3)
    triangles : ndarray of int, shape (T, 3)
    cell : float
        Width of a cell, in the unit of `positions`. No vertex moves further than its diagonal.

    Returns
    -------
    positions, triangles : ndarray
        The mesh itself where joining would take more of its area than `KEPT_AREA` leaves, or no triangles.
    """
    cells = np.floor(positions / cell).astype(np.int64)
    cells -= cells.min(axis=0)
    _, joined, count = np.unique(
        np.ravel_multi_index(tuple(cells.T), tuple(cells.max(axis=0) + 1)),
        return_inverse=True,
        return_counts=True,
    )
    middles = np.stack([np.bincount(joined, axis) for axis in positions.T], axis=1) / count[:, None]
    corners = np.sort(joined[triangles], axis=1)
    corners = corners[(corners[:, 0] != corners[:, 1]) & (corners[:, 1] != corners[:, 2])]
    kept = np.unique(corners, axis=0).astype(triangles.dtype)
    coarser = middles.astype(positions.dtype)
    if len(kept) == len(triangles) or _area(coarser, kept) < KEPT_AREA * _area(positions, triangles):
        return positions, triangles
    return coarser, kept


def _area(positions: Array, triangles: Indices) -> float:
    a, b, c = (positions[corner] for corner in triangles.T)
    return 0.5 * float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum(dtype=np.float64))
