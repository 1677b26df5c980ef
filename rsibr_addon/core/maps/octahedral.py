"""The octahedral map [Praun2003]: the sphere on an octahedron, unfolded into a square.

Own axes are the world's. The middle shows +z, the edges' middles the horizon's axes, and the four
corners -z: the upper half is the inner diamond, the lower half is folded outwards.
"""

import numpy as np

from ..conventions import Array, ArrayLike, Indices
from ..geometry.directions import dot


def direction_from_uv(uv: ArrayLike) -> Array:
    """The direction that a point of the map shows: see `core.maps`."""
    x, y = np.moveaxis(2.0 * np.asarray(uv, dtype=np.float64) - 1.0, -1, 0)
    direction = np.empty((3, *x.shape))
    direction[2] = 1.0 - np.abs(x) - np.abs(y)
    direction[:2] = _below_folded(x, y, direction[2])
    direction /= np.sqrt(np.sum(direction**2, axis=0))
    return np.moveaxis(direction, 0, -1)


def uv_from_direction(direction: ArrayLike) -> Array:
    """The inverse of `direction_from_uv`, of any positive length; -z is taken to the corner (1, 1)."""
    x, y, z = np.moveaxis(np.asarray(direction, dtype=np.float64), -1, 0)
    distance = np.abs(x) + np.abs(y) + np.abs(z)
    uv = _below_folded(x / distance, y / distance, z)
    return np.moveaxis(0.5 * uv + 0.5, 0, -1)


def texel_solid_angle(size: int) -> Array:
    """Solid angle of every texel [sr], shape (size, size): exact, sums to 4 pi.

    The map's lines are great circles within a face of the octahedron, so that a texel is made of spherical
    triangles [VanOosterom1983].
    """
    # Texels of a map twice as fine straddle no axis, and a fold only along their diagonal. One quadrant
    # serves for all; its diagonals from the upper left to the lower right run along the fold.
    lines = np.linspace(0.5, 1.0, size + 1)
    corners = direction_from_uv(np.stack(np.meshgrid(lines, lines), axis=-1))
    lower_left, lower_right = corners[:-1, :-1], corners[:-1, 1:]
    upper_left, upper_right = corners[1:, :-1], corners[1:, 1:]
    quadrant = _triangle(lower_left, lower_right, upper_left) + _triangle(
        upper_right, upper_left, lower_right
    )
    half = np.concatenate([quadrant[:, ::-1], quadrant], axis=1)
    square = np.concatenate([half[::-1], half], axis=0)
    solid_angle: Array = square.reshape(size, 2, size, 2).sum(axis=(1, 3))
    return solid_angle


def wrap(columns: Indices, rows: Indices, width: int, height: int) -> tuple[Indices, Indices]:
    """Texel that a lookup beyond the map's edge falls on: each edge is folded about its middle."""
    beside = (columns < 0) | (columns >= width)
    rows = np.where(beside, height - 1 - rows, rows)
    beyond = (rows < 0) | (rows >= height)
    columns = np.where(beyond, width - 1 - columns, columns)
    return _mirrored(columns, width), _mirrored(rows, height)


def _mirrored(index: Indices, size: int) -> Indices:
    """Texels beyond an edge to texels as far within."""
    return np.where(index < 0, -1 - index, np.where(index >= size, 2 * size - 1 - index, index))


def _below_folded(x: Array, y: Array, z: Array) -> Array:
    """Points, shape (2, ...), mirrored about the fold |x| + |y| = 1 of their quadrant where z is negative."""
    below = z < 0.0
    folded = [(1.0 - np.abs(b)) * np.where(a < 0.0, -1.0, 1.0) for a, b in ((x, y), (y, x))]
    return np.where(below, folded, [x, y])


def _triangle(a: Array, b: Array, c: Array) -> Array:
    """Solid angle of the triangle between unit vectors."""
    volume = np.abs(dot(a, np.cross(b, c)))
    solid_angle: Array = 2.0 * np.arctan2(volume, 1.0 + dot(a, b) + dot(b, c) + dot(c, a))
    return solid_angle
