"""Integration over the quadrilateral of a pixel's corner directions, [Miller1984] section 8.2.

The integral of a table of constant texels over a region of the sphere is, by Green's theorem, one along
its border: with z the sine of the latitude, x the longitude in columns (they run clockwise) and
F(x, z) the integral of radiance over z from the south pole up,

    integral of L domega = (2 pi / width) * closed integral of F dx   (border counterclockwise).

F is linear in z within a texel, and the integral of z along a great circle is an arc tangent. So an edge
costs one term for each line between texels that it crosses, whatever it encloses, and the result is exact.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..conventions import Array, ArrayLike, Indices
from ..geometry.directions import dot
from ..maps import equirect
from .recursive import recursive_mean

BLOCK = 1 << 14
"""Footprints integrated at once: some 100 MB for those that cross ten texels."""

LEAST_AREA = 1e-10
"""[sr] Least area of a footprint: below it, rounding, about 1e-17, begins to show in the area."""


def quadrilateral_mean(radiance: Array, corners: ArrayLike) -> Array:
    """Mean of a table over the quadrilaterals that pixels' corners span on the sphere.

    Parameters
    ----------
    radiance : ndarray, shape (height, width, channels)
        An equirectangular table; a texel stands for a constant radiance over its solid angle.
    corners : array_like, shape (..., 4, 3)
        Unit directions in order around the pixel.

    Returns
    -------
    ndarray, shape (..., channels), float64
        The mean of the means over solid angle of two triangles, halves of the pixel.

    Notes
    -----
    [Miller1984] section 8.2 divides the integral over the whole quadrilateral by its area; where the
    surface's curvature changes its sign the reflection is folded, and a folded quadrilateral has no area to
    divide by. Its halves have one, except on the fold itself: such lines and points are left to
    `recursive_mean`. No GLSL twin.
    """
    corners = np.asarray(corners, dtype=np.float64)
    quads = corners.reshape(-1, 4, 3)
    table = _column_sums(radiance)
    mean = np.empty((len(quads), radiance.shape[-1]))
    for first in range(0, len(quads), BLOCK):
        mean[first : first + BLOCK] = _block_mean(table, radiance, quads[first : first + BLOCK])
    return mean.reshape(*corners.shape[:-2], radiance.shape[-1])


@dataclass(frozen=True)
class _ColumnSums:
    """F of the module's docstring: below row j, `offset` + `slope` z.

    Attributes
    ----------
    slope, offset : ndarray, shape (height, width, channels + 1)
        The last channel is a radiance of 1: its integrals are solid angles.
    total : ndarray, shape (channels + 1,)
        Integral over the sphere.
    """

    slope: Array
    offset: Array
    total: Array


def _column_sums(radiance: Array) -> _ColumnSums:
    height, width = radiance.shape[:2]
    slope = np.concatenate([radiance, np.ones((height, width, 1))], axis=-1, dtype=np.float64)
    band = equirect.texel_solid_angle(width, height)[..., None] * (width / (2.0 * np.pi))
    above = np.cumsum(slope * band, axis=0)
    lower_edge = -np.cos(np.pi * np.arange(height) / height)[:, None, None]
    total = np.sum(above[-1], axis=0) * (2.0 * np.pi / width)
    return _ColumnSums(slope, above - slope * (band + lower_edge), total)


def _block_mean(table: _ColumnSums, radiance: Array, quads: Array) -> Array:
    a, b, c, d = np.moveaxis(quads, 1, 0)
    border = _edge_integrals(table, np.stack([a, b, c, d, a]), np.stack([b, c, d, a, c]))
    halves = np.stack([border[0] + border[1] - border[4], border[4] + border[2] + border[3]])
    orientation = np.sign([dot(np.cross(a, b), c), dot(np.cross(a, c), d)])
    halves *= orientation[..., None]
    # Around the north pole, columns run backwards a whole turn and F is integrated over all the rest.
    north = halves[..., -1] < -np.pi
    integral = halves[..., :-1] + north[..., None] * table.total
    area = integral[..., -1:]
    with_area = np.all(area > LEAST_AREA, axis=(0, 2))
    mean = np.empty((len(quads), radiance.shape[-1]))
    mean[with_area] = np.mean(integral[:, with_area, :-1] / area[:, with_area], axis=0)
    mean[~with_area] = recursive_mean(radiance, quads[~with_area])
    return mean


def _edge_integrals(table: _ColumnSums, start: Array, end: Array) -> Array:
    """Integrals of F dx along great circles, and of dx.

    Parameters
    ----------
    table : _ColumnSums
    start, end : ndarray, shape (edges, n, 3)

    Returns
    -------
    ndarray, shape (edges, n, channels + 2)
        Integrals times 2 pi / width; the last but one is that of a radiance of 1, the last that of dx.
    """
    height, width = table.slope.shape[:2]
    circle = _GreatCircles.through(start.reshape(-1, 3), end.reshape(-1, 3), width)
    edges, x = _points(circle, width, height)
    within = edges[1:] == edges[:-1]
    edges, left, right = edges[:-1][within], x[:-1][within], x[1:][within]
    middle = 0.5 * (left + right)
    rows = np.floor(circle.latitude(edges, middle) * (height / np.pi) + 0.5 * height).astype(np.intp)
    texel = np.clip(rows, 0, height - 1), np.floor(middle).astype(np.intp) % width
    length = (right - left) * (2.0 * np.pi / width)
    pieces = np.empty((len(edges), table.slope.shape[-1] + 1))
    z_length = circle.z_integral(edges, right) - circle.z_integral(edges, left)
    pieces[:, :-1] = table.offset[texel] * length[:, None] + table.slope[texel] * z_length[:, None]
    pieces[:, -1] = length
    first = np.searchsorted(edges, np.arange(len(circle.start)))
    integrals: Array = np.sign(circle.run)[:, None] * np.add.reduceat(pieces, first, axis=0)
    return integrals.reshape(*start.shape[:-1], -1)


@dataclass(frozen=True)
class _GreatCircles:
    """Edges over the longitude in columns: tan(latitude) = `tilt` / `level` * cos(`angle`(x - `apex`)).

    Attributes
    ----------
    start, run : ndarray, shape (n,)
        Longitude at which an edge starts, and its length along it, half a turn either way at most.
    apex : ndarray, shape (n,)
        Where its circle is farthest north.
    tilt, level : ndarray, shape (n,)
        Parts of the circle's normal across and along the axis; not normalised, not negative.
    angle : float
        Width of a column [rad].
    """

    start: Array
    run: Array
    apex: Array
    tilt: Array
    level: Array
    angle: float

    @classmethod
    def through(cls, start: Array, end: Array, width: int) -> "_GreatCircles":
        normal = np.cross(start + end, end - start)  # of short edges too, with all digits
        normal = np.where(normal[:, 2:] < 0.0, -normal, normal)
        x = width * equirect.uv_from_direction(np.stack([start, end, normal * (-1.0, -1.0, 0.0)]))[..., 0]
        run = x[1] - x[0]
        run -= width * np.round(run / width)
        tilt = np.hypot(normal[:, 0], normal[:, 1])
        return cls(x[0], run, x[2], tilt, normal[:, 2], 2.0 * np.pi / width)

    def latitude(self, edges: Indices, x: Array) -> Array:
        """Latitude of points of edges [rad]."""
        across = self.tilt[edges] * np.cos(self.angle * (x - self.apex[edges]))
        return np.arctan2(across, self.level[edges])

    def z_integral(self, edges: Indices, x: Array) -> Array:
        """Integral of z over the longitude in radians, from the apex to points of edges."""
        psi = self.angle * (x - self.apex[edges])
        tilt = self.tilt[edges]
        return np.arctan2(tilt * np.sin(psi), np.hypot(self.level[edges], tilt * np.cos(psi)))


def _points(circle: _GreatCircles, width: int, height: int) -> tuple[Indices, Array]:
    """Ends of edges, and where they cross lines between texels: edge and longitude, in order."""
    low = np.minimum(circle.start, circle.start + circle.run)
    high = np.maximum(circle.start, circle.start + circle.run)
    every = np.arange(len(low))
    at_column, columns = _integers_between(low, high)
    lowest, highest = _rows_reached(circle, low, high, width, height)
    at_row, rows = _integers_between(lowest, highest)
    # A circle crosses a parallel twice, as far before its apex as behind.
    slope = np.tan(np.pi * (rows / height - 0.5)) * circle.level[at_row] / circle.tilt[at_row]
    away = np.arccos(np.clip(slope, -1.0, 1.0)) / circle.angle
    crossing = circle.apex[at_row] + np.stack([-away, away])
    crossing = low[at_row] + (crossing - low[at_row]) % width
    inside = crossing < high[at_row]
    edges = np.concatenate([every, every, at_column, *(at_row[side] for side in inside)])
    x = np.concatenate([low, high, columns, crossing[inside]])
    order = np.lexsort((x, edges))
    return edges[order], x[order]


def _rows_reached(
    circle: _GreatCircles, low: Array, high: Array, width: int, height: int
) -> tuple[Array, Array]:
    """The southernmost and the northernmost point of edges, in rows."""
    every = np.arange(len(low))
    ends = circle.latitude(every, low), circle.latitude(every, high)
    steepest = np.arctan2(circle.tilt, circle.level)

    def passes(x: Array) -> NDArray[np.bool]:
        through: NDArray[np.bool] = np.floor((high - x) / width) > np.floor((low - x) / width)
        return through

    northmost = np.where(passes(circle.apex), steepest, np.maximum(*ends))
    southmost = np.where(passes(circle.apex + 0.5 * width), -steepest, np.minimum(*ends))
    scale = height / np.pi
    return southmost * scale + 0.5 * height, northmost * scale + 0.5 * height


def _integers_between(low: Array, high: Array) -> tuple[Indices, Array]:
    """All integers strictly within intervals: the interval's number, and the integer."""
    first = np.floor(low) + 1.0
    count = np.maximum(np.ceil(high) - first, 0.0).astype(np.intp)
    of = np.repeat(np.arange(len(low)), count)
    place = np.arange(len(of)) - np.repeat(np.cumsum(count) - count, count)
    return of, first[of] + place
