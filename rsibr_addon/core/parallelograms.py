"""Parallelograms that lines of a grid cut."""

import numpy as np

from .conventions import Array


def parts_beyond(distance: Array, edges: Array) -> Array:
    """Parts of a parallelogram beyond a vertical line right of its centre, and a horizontal one above.

    Parameters
    ----------
    distance : ndarray, shape (2, M)
        From the centre to the vertical and to the horizontal line, at least 0.
    edges : ndarray, shape (2, 2, M)
        Two vectors of x and y.

    Returns
    -------
    ndarray, shape (3, M)
        Parts of its area, in [0, 1], that lie beyond the vertical line only, beyond the horizontal
        line only, and beyond both.
    """
    right, above = _part_beyond_line(distance, np.abs(edges[0]), np.abs(edges[1]))
    both = np.zeros_like(right)
    cut_twice = np.flatnonzero((right > 0.0) & (above > 0.0))
    both[cut_twice] = np.minimum(
        _part_beyond_corner(np.take(distance, cut_twice, axis=-1), np.take(edges, cut_twice, axis=-1)),
        np.minimum(np.take(right, cut_twice), np.take(above, cut_twice)),
    )
    return np.stack([right - both, above - both, both])


def _part_beyond_line(distance: Array, a: Array, b: Array) -> Array:
    """Part of a parallelogram beyond a line, given the extents of its edges across the line.

    Its extent along the line is a trapezoid: a box of width a blurred by one of width b.
    """
    longer, twice_area = np.maximum(a, b), 2.0 * a * b
    reach = 0.5 * (a + b)
    slope = np.maximum(reach - distance, 0.0) ** 2 / np.where(twice_area > 0.0, twice_area, 1.0)
    top = 0.5 - distance / np.where(longer > 0.0, longer, 1.0)
    part: Array = np.where(distance < longer - reach, top, slope)
    return part


def _part_beyond_corner(distance: Array, edges: Array) -> Array:
    """Part of a parallelogram to the right of a vertical and above a horizontal line.

    Summed over its sides: the areas between each, where it is right of the one line and above the other,
    and the horizontal line; above the parallelogram's lower sides they are taken away again.
    """
    area = edges[0, 0] * edges[1, 1] - edges[0, 1] * edges[1, 0]
    corners = [
        0.5 * (a * edges[0] + b * edges[1]) - distance for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))
    ]
    total = np.zeros_like(area)
    for (x0, y0), (x1, y1) in zip(corners, corners[1:] + corners[:1], strict=True):
        start, end = np.maximum(x0, 0.0), np.maximum(x1, 0.0)
        slope = (y1 - y0) / np.where(x1 == x0, 1.0, x1 - x0)
        y_start, y_end = y0 + slope * (start - x0), y0 + slope * (end - x0)
        height = np.abs(y_end - y_start)
        ramp = np.maximum(np.maximum(y_start, y_end), 0.0) ** 2 / np.where(height > 0.0, 2.0 * height, 1.0)
        above = np.minimum(y_start, y_end) >= 0.0
        total += (start - end) * np.where(above, 0.5 * (y_start + y_end), ramp)
    part: Array = np.clip(total / np.where(area == 0.0, 1.0, area), 0.0, 1.0)
    return part
