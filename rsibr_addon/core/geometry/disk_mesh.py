"""The tessellated disk on which the `paper` mode draws a destination map.

[Cabral1999] section 3.3: texture coordinates are computed at the vertices of a disk, "finer
toward the edges of the disk and coarser near the center", and interpolated in between.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np

from ..conventions import Array, ArrayLike, Indices

RINGS = 32
SECTORS = 64
MARGIN = 1.25
"""Radius of the outermost vertices. The disk is drawn beyond its rim, with the rim's texture coordinates, so
that bilinear lookups at the rim find the rim's own radiance. This margin covers the texels that such a lookup
can reach, a diagonal beyond the rim, in maps of 12 texels or more."""


@dataclass(frozen=True)
class DiskMesh:
    """Triangles over the disk and its margin.

    Attributes
    ----------
    positions : ndarray, shape (V, 2), float64
        On the map, in [-MARGIN, MARGIN], the rim at radius 1.
    triangles : ndarray, shape (F, 3), int
    """

    positions: Array
    triangles: Indices


def _ring_radii() -> Array:
    """Radii of the rings from the centre outwards, shape (RINGS + 2,).

    Normals turn by equal angles from ring to ring, so rings crowd towards the rim as the warp's
    curvature does; the last ring is the margin.
    """
    turn = np.linspace(0.0, np.pi / 2.0, RINGS + 1)
    return np.append(np.sin(turn), MARGIN)


@cache
def disk_mesh() -> DiskMesh:
    """The one tessellation that serves every view."""
    radii = _ring_radii()[1:]
    angles = 2.0 * np.pi * np.arange(SECTORS) / SECTORS
    unit = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    rings = (radii[:, None, None] * unit).reshape(-1, 2)
    positions = np.concatenate([np.zeros((1, 2)), rings])
    return DiskMesh(positions, _corners(*np.divmod(np.arange((RINGS + 1) * SECTORS), SECTORS)).reshape(-1, 3))


def _vertex(ring: Indices, sector: Indices) -> Indices:
    """Index of the vertex on `ring` (0 is the centre) at the start of `sector`."""
    index: Indices = np.where(ring == 0, 0, 1 + (ring - 1) * SECTORS + sector % SECTORS)
    return index


def _corners(ring: Indices, sector: Indices) -> Indices:
    """Vertices of the two triangles between `ring` and the next, shape (..., 2, 3).

    At the centre, where the inner edge shrinks to a point, the second triangle is empty.
    """
    inner, inner_next = _vertex(ring, sector), _vertex(ring, sector + 1)
    outer, outer_next = _vertex(ring + 1, sector), _vertex(ring + 1, sector + 1)
    first = np.stack([inner, outer, outer_next], axis=-1)
    second = np.stack([inner, outer_next, inner_next], axis=-1)
    return np.stack([first, second], axis=-2)


def interpolate(points: ArrayLike, values: ArrayLike) -> Array:
    """Values at vertices of `disk_mesh`, interpolated linearly within each triangle.

    Parameters
    ----------
    points : array_like, shape (..., 2)
        Points of the disk and its margin, within radius 0.99 MARGIN.
    values : array_like, shape (V, channels)
        One row a vertex.

    Returns
    -------
    ndarray, shape (..., channels), float64
        Values that a rasteriser interpolates at those points.
    """
    points = np.asarray(points, dtype=np.float64)
    values = np.asarray(values)
    step = 2.0 * np.pi / SECTORS
    angle = np.mod(np.arctan2(points[..., 1], points[..., 0]), 2.0 * np.pi)
    sector = np.minimum((angle / step).astype(np.intp), SECTORS - 1)
    # Rings are polygons: the distance along the sector's bisector tells a point's ring.
    along = np.linalg.norm(points, axis=-1) * np.cos(angle - (sector + 0.5) * step) / np.cos(0.5 * step)
    ring = np.searchsorted(_ring_radii(), along, side="right") - 1
    corners = _corners(ring, sector)
    mesh = disk_mesh()
    weights = _affine_weights(points[..., None, :], mesh.positions[corners])
    # The diagonal divides the two: the one that holds the point has no negative weight.
    fits = np.nan_to_num(weights.min(axis=-1), nan=-np.inf)
    better = np.argmax(fits, axis=-1)[..., None, None]
    chosen = np.take_along_axis(corners, better, axis=-2)[..., 0, :]
    weight = np.take_along_axis(weights, better, axis=-2)[..., 0, :]
    interpolated: Array = np.einsum("...i,...ic->...c", weight, values[chosen])
    return interpolated


def _affine_weights(points: Array, corners: Array) -> Array:
    """Planar barycentric weights, shape (..., 3); NaN in an empty triangle."""
    a, b, c = (corners[..., i, :] for i in range(3))

    def cross(u: Array, v: Array) -> Array:
        area: Array = u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]
        return area

    with np.errstate(invalid="ignore", divide="ignore"):
        total = cross(b - a, c - a)
        second = cross(points - a, c - a) / total
        third = cross(b - a, points - a) / total
    return np.stack([1.0 - second - third, second, third], axis=-1)
