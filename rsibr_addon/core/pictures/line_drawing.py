"""Lines as pixels, with smooth edges, for plots where vector drawings cannot be shown."""

import numpy as np

from ..conventions import Array, ArrayLike

SPACING = 0.5
"""Distance between the points that sample a line, in pixels."""

DASH, GAP = 7.0, 4.0
"""Lengths along a dashed line, in pixels."""


def line_coverage(points: ArrayLike, shape: tuple[int, int], width: float, dashed: bool = False) -> Array:
    """Share of each pixel that a line covers.

    Parameters
    ----------
    points : array_like, shape (N, 2)
        The line's corners, two or more: (x, y) in pixels from the top left corner of the picture, y
        downwards, as in vector drawings. Parts outside the picture are left out.
    shape : tuple of two int
        Height and width of the picture.
    width : float
        Width of the line in pixels, at least 1.
    dashed : bool

    Returns
    -------
    ndarray, shape (height, width)
        In [0, 1]; row 0 is the bottom row. Computed from the distance of a pixel's centre to the line: exact
        for a straight line along an axis, nearly exact at other angles.
    """
    corners = np.asarray(points, dtype=np.float64)
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(corners, axis=0), axis=1))])
    at = np.arange(0.0, along[-1] + SPACING, SPACING)
    if dashed:
        at = at[at % (DASH + GAP) < DASH]
    line = np.stack([np.interp(at, along, corner) for corner in corners.T], axis=-1)
    farthest = np.ceil(0.5 * width)
    reach = np.arange(-farthest, farthest + 1.0)
    around = np.stack(np.meshgrid(reach, reach), axis=-1).reshape(-1, 2)
    pixels = np.floor(line)[:, None] + around
    distance = np.linalg.norm(pixels + 0.5 - line[:, None], axis=-1)
    covered = np.clip(0.5 * (width + 1.0) - distance, 0.0, 1.0)
    columns, rows = np.moveaxis(pixels.astype(np.intp), -1, 0)
    inside = (rows >= 0) & (rows < shape[0]) & (columns >= 0) & (columns < shape[1])
    coverage = np.zeros(shape)
    np.maximum.at(coverage, (rows[inside], columns[inside]), covered[inside])
    return coverage[::-1]
