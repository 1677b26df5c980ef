"""The footprint of a pixel on the sphere of directions: from a picture's grid, and its box on a table."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ..conventions import Array, ArrayLike
from ..maps import equirect
from .sampling import sample_counts

PART_ROWS = 2.0
"""Rows of a table that a part of a footprint is high or wide, at least."""


def pixel_footprints(directions: ArrayLike) -> Array:
    """The footprints of a picture's pixels.

    Parameters
    ----------
    directions : array_like, shape (height + 1, width + 1, 3)
        Unit directions reflected at the corners of the pixels, row 0 at the bottom.

    Returns
    -------
    ndarray, shape (height, width, 4, 3)
        Each pixel's corners counterclockwise from the left one at the bottom.
    """
    grid = np.asarray(directions, dtype=np.float64)
    return np.stack([grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]], axis=-2)


def parallelogram(middle: ArrayLike, across: ArrayLike, up: ArrayLike) -> Array:
    """The footprints of pixels whose directions change evenly.

    Parameters
    ----------
    middle : array_like, shape (..., 3)
        Unit directions that the pixels' middles reflect.
    across, up : array_like, shape (..., 3)
        Change of the direction from a pixel to the next one on its right, and to the next above.

    Returns
    -------
    ndarray, shape (..., 4, 3)
        Corners in the order of `pixel_footprints`, with lengths near 1.

    Notes
    -----
    A graphics card knows just this of a pixel: differences to its neighbours. GLSL twin:
    gpu_shaders/lib/footprint_lib.glsl `parallelogram`, three roundings.
    """
    middle, across, up = np.asarray(middle), 0.5 * np.asarray(across), 0.5 * np.asarray(up)
    corners = (middle - across - up, middle + across - up, middle + across + up, middle - across + up)
    return np.stack(corners, axis=-2)


def footprint_or_point(corners: ArrayLike | None, middle: Array) -> Array:
    """The given footprints; or footprints of points, which reflect one direction each.

    Parameters
    ----------
    corners : array_like, shape (..., 4, 3), or None
    middle : ndarray, shape (..., 3)
        Unit directions that the points reflect.

    Returns
    -------
    ndarray, shape (..., 4, 3)
    """
    if corners is None:
        return parallelogram(middle, np.zeros(3), np.zeros(3))
    return np.asarray(corners, dtype=np.float64)


def footprint_sides(corners: Array) -> tuple[Array, Array]:
    """The sides of footprints, taken as parallelograms.

    Parameters
    ----------
    corners : ndarray, shape (..., 4, 3)

    Returns
    -------
    across, up : ndarray, shape (..., 3)
        Means of opposite sides, as `parallelogram` takes them.
    """
    across = 0.5 * (corners[..., 1, :] - corners[..., 0, :] + corners[..., 2, :] - corners[..., 3, :])
    up = 0.5 * (corners[..., 3, :] - corners[..., 0, :] + corners[..., 2, :] - corners[..., 1, :])
    return across, up


def footprint_box(corners: ArrayLike, width: int, height: int) -> Array:
    """The smallest rectangle of a table that holds a footprint's corners, at least a texel wide and high.

    Parameters
    ----------
    corners : array_like, shape (..., 4, 3)
        Directions of any positive length, in order around the pixel.
    width, height : int
        Size of the table in texels.

    Returns
    -------
    ndarray, shape (..., 4), float64
        u and v of the box's lower left corner, u in [0, 1); u and v of its upper right one, u beyond 1
        where the box crosses the seam, by one turn at most.

    Notes
    -----
    [Miller1984] section 8.3. Where a pole lies in the footprint, the box goes all around that pole. The mean
    over a box of one texel is bilinear interpolation of the texels around its middle, which is right for a
    smaller footprint. GLSL twin: gpu_shaders/lib/summed_area_lib.glsl `footprint_box`.
    """
    uv = equirect.uv_from_direction(corners)
    u, v = uv[..., 0], uv[..., 1]
    # From corner to corner around the pixel, the short way; that makes a turn only around a pole.
    steps = np.roll(u, -1, axis=-1) - u
    steps -= np.round(steps)
    around = np.abs(np.sum(steps, axis=-1)) > 0.5
    ahead = np.cumsum(steps[..., :3], axis=-1)
    low_u = u[..., 0] + np.minimum(np.min(ahead, axis=-1), 0.0)
    high_u = u[..., 0] + np.maximum(np.max(ahead, axis=-1), 0.0)
    low_v, high_v = np.min(v, axis=-1), np.max(v, axis=-1)
    north = np.sum(v, axis=-1) > 2.0
    low_u, high_u = np.where(around, 0.0, low_u), np.where(around, 1.0, high_u)
    low_v, high_v = np.where(around & ~north, 0.0, low_v), np.where(around & north, 1.0, high_v)
    low_u, high_u = _grown(low_u, high_u, 1.0 / width)
    low_v, high_v = _grown(low_v, high_v, 1.0 / height)
    turn = np.floor(low_u)
    return np.stack([low_u - turn, np.maximum(low_v, 0.0), high_u - turn, np.minimum(high_v, 1.0)], axis=-1)


def footprint_parts(corners: Array, height: int) -> Iterator[tuple[NDArray[np.bool], Array, Array]]:
    """Parts of footprints, whose boxes hold less that is no part of the footprint.

    Parameters
    ----------
    corners : ndarray, shape (..., 4, 3)
        Directions of lengths near 1, in order around the pixel.
    height : int
        Of the table, in texels.

    Yields
    ------
    chosen : ndarray of bool, shape (...,)
        The footprints that have a further part.
    part : ndarray, shape (n, 4, 3)
        The corners of that part.
    weight : ndarray, shape (n, 1)
        One over the number of a footprint's parts.

    Notes
    -----
    A pixel's area is parted evenly: along each side into as many as leave two rows to each, but `MOST` at
    most. GLSL twin: gpu_shaders/lib/averaging_lib.glsl `summed_mean`.
    """
    counts = sample_counts(*footprint_sides(corners), PART_ROWS * np.pi / height)
    number_of = np.prod(counts, axis=-1)
    for number in range(int(number_of.max(initial=0))):
        chosen = number < number_of
        row, column = np.divmod(number, counts[chosen][..., 0])
        low = np.stack([column, row], axis=-1) / counts[chosen]
        high = low + 1.0 / counts[chosen]
        places = ((low, low), (high, low), (high, high), (low, high))
        part = np.stack([_within(corners[chosen], x[..., :1], y[..., 1:]) for x, y in places], axis=-2)
        yield chosen, part, 1.0 / number_of[chosen][:, None]


def _within(corners: Array, across: Array, up: Array) -> Array:
    """Directions within footprints, from 0 to 1 along their sides, shape (n, 3)."""
    lower = corners[:, 0] + across * (corners[:, 1] - corners[:, 0])
    upper = corners[:, 3] + across * (corners[:, 2] - corners[:, 3])
    within: Array = lower + up * (upper - lower)
    return within


def _grown(low: Array, high: Array, least: float) -> tuple[Array, Array]:
    """An interval made at least so long, about its middle."""
    missing = 0.5 * np.maximum(least - (high - low), 0.0)
    return low - missing, high + missing
