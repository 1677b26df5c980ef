"""Where on a picture a surface is baked: whether a UV map will do, and an unwrapping that always does."""

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from ..conventions import Array, Indices

EDGE = 1e-4
"""How far beyond the picture a UV map may reach, as rounding makes it."""

SHARE = 2e-3
"""Share of a surface, or of its texels, that may be at fault without being seen."""

LOOKED_AT = 512
"""Width of the picture on which overlaps are looked for."""

AT_ONCE = 2**19
"""Texels of triangles' boxes that are looked at together; they take some 200 bytes each."""

LEAST_CELL = 2
"""Logarithm of the width of the smallest cell: a border of one texel, and two within it."""


def covering(uv: Array, size: int) -> Indices:
    """How many triangles each texel's centre lies in.

    Parameters
    ----------
    uv : ndarray, shape (T, 3, 2)
        Corners; the picture is the unit square.
    size : int
        Width and height in texels.

    Returns
    -------
    ndarray of int, shape (size, size)
        Row 0 at the bottom. A centre on an edge lies in neither of its triangles.
    """
    counts: Indices = np.zeros((size, size), int)
    for some in _covered(uv, size):
        counts += some
    return counts


def _covered(uv: Array, size: int) -> Iterator[Indices]:
    """The counts of `covering`, of a part of the triangles at a time."""
    corners = np.asarray(uv, np.float64) * size - 0.5  # now the centres are whole numbers
    low = np.clip(np.ceil(corners.min(axis=1)), 0, size).astype(int)
    high = np.clip(np.floor(corners.max(axis=1)) + 1, 0, size).astype(int)
    extent = np.maximum(high - low, 0)
    part = np.cumsum(extent.prod(axis=1)) // AT_ONCE
    ends = np.flatnonzero(np.diff(part, append=-1)) + 1
    for begin, end in pairwise([0, *ends.tolist()]):
        yield _inside(corners[begin:end], low[begin:end], extent[begin:end], size)


def _inside(corners: Array, low: Indices, extent: Indices, size: int) -> Indices:
    """How many of some triangles each centre lies in, by the boxes around them."""
    wide, texels = extent[:, 0], extent.prod(axis=1)
    triangle = np.repeat(np.arange(len(corners)), texels)
    place = np.arange(len(triangle)) - np.repeat(np.cumsum(texels) - texels, texels)
    row, column = np.divmod(place, wide[triangle])
    row, column = row + low[triangle, 1], column + low[triangle, 0]
    sides = []
    for first, second in ((0, 1), (1, 2), (2, 0)):
        x, y = corners[triangle, first].T
        along, up = (corners[triangle, second] - corners[triangle, first]).T
        sides.append(along * (row - y) - up * (column - x))
    inside = np.all(np.array(sides) > 1e-9, axis=0) | np.all(np.array(sides) < -1e-9, axis=0)
    counts: Indices = np.zeros((size, size), int)
    np.add.at(counts, (row[inside], column[inside]), 1)
    return counts


def fault_of(uv: Array, areas: Array) -> str:
    """Why a UV map cannot hold what is baked of a surface.

    Parameters
    ----------
    uv : ndarray, shape (T, 3, 2)
        Corners of the surface's triangles.
    areas : ndarray, shape (T,)
        Their areas on the surface.

    Returns
    -------
    str
        What the UV map does, as "overlaps"; empty where it will do.
    """
    if uv.min(initial=0.0) < -EDGE or uv.max(initial=1.0) > 1.0 + EDGE:
        return "reaches beyond its first tile"
    (a, b), (c, d) = (uv[:, 1] - uv[:, 0]).T, (uv[:, 2] - uv[:, 0]).T
    flat = np.abs(a * d - b * c) < 1e-12
    if areas[flat].sum() > SHARE * areas.sum():
        return "has faces without area"
    counts = np.zeros((LOOKED_AT, LOOKED_AT), int)
    for some in _covered(uv, LOOKED_AT):
        counts += some
        # However much the rest covers: thousands of faces may each fill the picture
        if np.count_nonzero(counts > 1) > SHARE * counts.size:
            return "overlaps"
    return "overlaps" if np.count_nonzero(counts > 1) > SHARE * np.count_nonzero(counts) else ""


def fitting_size(faces: int, size: int) -> int:
    """Width of a picture on which `unwrapped` can lay out faces: a power of 2.

    Parameters
    ----------
    faces : int
    size : int
        The width that is wished; it is rounded down, or up until all faces have a cell.
    """
    power = int(np.log2(size))
    while faces * 4**LEAST_CELL > 4**power:
        power += 1
    return 1 << power


def unwrapped(corners: Indices, areas: Array, size: int) -> Array:
    """Lay out faces on a picture, each in a square cell of its own.

    Parameters
    ----------
    corners : ndarray of int, shape (P,)
        Number of corners of each face, at least 3.
    areas : ndarray, shape (P,)
        On the surface: a cell's width follows the square root, in powers of 2.
    size : int
        Of the picture; see `fitting_size`.

    Returns
    -------
    ndarray, shape (sum of `corners`, 2)
        Places of all corners, face by face. Between a face and the border of its cell there is a texel.

    Notes
    -----
    Cells are dealt out from large to small along a Z-order curve, on which each then begins at a multiple of
    its own area.
    """
    widths = _widths(areas, size)
    order = np.argsort(-widths, kind="stable")
    begins = np.empty(len(widths), np.int64)
    begins[order] = np.cumsum(4 ** widths[order]) - 4 ** widths[order]
    low = np.stack([_every_second_bit(begins), _every_second_bit(begins >> 1)], axis=-1)
    face = np.repeat(np.arange(len(corners)), corners)
    number = np.arange(len(face)) - np.repeat(np.cumsum(corners) - corners, corners)
    within = (2.0 ** widths[face])[:, None] - 2.0
    placed: Array = (low[face] + 1.0 + within * _shape(number, corners[face])) / size
    return placed


def _widths(areas: Array, size: int) -> Indices:
    """Logarithms of cells' widths: the largest with which all cells fit."""
    power = int(np.log2(size))
    relative = 0.5 * np.log2(np.maximum(areas, 1e-30) / np.maximum(areas.max(), 1e-30))
    for shift in np.arange(0.0, 64.0, 0.125):
        widths = np.clip(np.floor(power + relative - shift), LEAST_CELL, power).astype(np.int64)
        if np.sum(4**widths) <= 4**power:
            break
    found: Indices = widths
    return found


def _every_second_bit(number: Indices) -> Indices:
    bits = [((number >> (2 * bit)) & 1) << bit for bit in range(31)]
    joined: Indices = np.sum(bits, axis=0)
    return joined


def _shape(number: Indices, corners: Indices) -> Array:
    """A face's corners on the unit square: of four its own, of three half of it, of more on a circle."""
    angle = 2.0 * np.pi * number / corners
    circle = 0.5 + 0.5 * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], float)[np.minimum(number, 3)]
    half = np.array([[0, 0], [1, 0], [0, 1]], float)[np.minimum(number, 2)]
    shaped: Array = np.where((corners == 3)[:, None], half, np.where((corners == 4)[:, None], square, circle))
    return shaped
