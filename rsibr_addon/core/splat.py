"""The power of one map, splatted onto the texels of another by the area that they share.

A texel has constant radiance over its solid angle. On a sheet of another map it is nearly a parallelogram:
its middle is where its centre falls, and its edges reach half-way to its neighbours' centres. Its solid angle
is divided exactly among the texels beneath, by the parts of the parallelogram that lie on each. A texel that
is larger than those beneath is quartered until it is not. All of it goes somewhere, so power is kept to the
last digits in all maps.
"""

import itertools
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from .conventions import Array, Indices
from .geometry.directions import dot
from .maps.representation import Representation
from .threads import in_order
from .ties import TIE

Scalar = TypeVar("Scalar", bound=np.generic)

TILE = 192
"""Rows and columns of a map at a time, so that their data stay in a processor's cache however large it is."""

BLOCK = TILE**2
"""Texels at a time where they do not make a tile."""

Shares = Iterator[tuple[Indices, Array, Array]]
"""What texels of the target get: their numbers, shape (M,), solid angles (M,) and powers (channels, M)."""

DEEPEST = 4
"""Most quarterings of a texel around a pole, or on a rim that is a single direction."""


@dataclass(frozen=True)
class _Texels:
    """Grids of neighbouring texels, or of parts of texels.

    Attributes
    ----------
    uv : ndarray, shape (rows, columns, grids, 2)
        The texels' centres on their own map.
    direction : ndarray, shape (rows, columns, grids, 3)
        What the centres show.
    sheet : ndarray of int, shape (rows, columns, grids)
    step : ndarray, shape (2,)
        The texels' width and height in uv.
    solid_angle : ndarray, shape (rows, columns, grids)
        [sr]
    radiance : ndarray, shape (channels, rows, columns, grids)
    """

    uv: Array
    direction: Array
    sheet: Indices
    step: Array
    solid_angle: Array
    radiance: Array


class Splat:
    """A map that collects what is laid down on it.

    Parameters
    ----------
    target : Representation
    size : int
        Width of its sheets in texels.
    channels : int
        How many the laid down maps have.

    Attributes
    ----------
    solid_angle : ndarray, shape (sheets * height * width,)
        What each texel has got [sr]. Of a map that shows all directions this is the texel's own, but
        for the difference between its neighbours' true outlines and parallelograms.
    power : ndarray, shape (channels, sheets * height * width)
        Radiance times solid angle.
    texel_solid_angle : ndarray, shape (sheets, height, width)
        The texels' own [sr].
    """

    def __init__(self, target: Representation, size: int, channels: int) -> None:
        self._target = target
        _, self._height, self._width = target.shape(size)
        self.texel_solid_angle = target.texel_solid_angle(size)
        self._counts = self.texel_solid_angle.ravel() > 0.0
        self.solid_angle = np.zeros(self._counts.size)
        self.power = np.zeros((channels, self._counts.size))

    def lay_down(self, image: Array, source: Representation) -> None:
        """Lay down a whole map.

        Parameters
        ----------
        image : ndarray, shape (sheets, height, width, channels)
            Radiance.
        source : Representation
        """
        sheets, height, width = image.shape[:3]
        solid_angle = source.texel_solid_angle(width)
        u, v = (np.arange(width) + 0.5) / width, (np.arange(height) + 0.5) / height

        def shares_of(tile: tuple[int, int, int]) -> list[tuple[Indices, Array, Array]]:
            sheet, *first = tile
            # With a rim of texels more, of no weight: edges are known from both neighbours.
            rows, columns = (slice(max(start - 1, 0), start + TILE + 1) for start in first)
            weight = np.zeros((len(v[rows]), len(u[columns]), 1))
            own = tuple(
                slice(start - rim.start, start - rim.start + TILE)
                for start, rim in zip(first, (rows, columns), strict=True)
            )
            weight[own] = solid_angle[sheet, rows, columns, None][own]
            uv = np.stack(np.broadcast_arrays(u[columns], v[rows, None]))[..., None]
            texels = _Texels(
                np.moveaxis(uv, 0, -1),
                source.direction_of_grid(u[columns], v[rows], sheet)[:, :, None],
                np.full(weight.shape, sheet),
                np.array([1.0 / width, 1.0 / height]),
                weight,
                np.moveaxis(image[sheet, rows, columns, None], -1, 0).astype(np.float64, order="C"),
            )
            return list(self._of_grids(source, texels, DEEPEST))

        tiles = itertools.product(range(sheets), range(0, height, TILE), range(0, width, TILE))
        for shares in in_order(shares_of, tiles):
            for texel, weight, power in shares:
                np.add.at(self.solid_angle, texel, weight)
                for sums, values in zip(self.power, power, strict=True):
                    np.add.at(sums, texel, values)

    def _of_grids(self, source: Representation, texels: _Texels, quarterings: int) -> Shares:
        weight = np.where(self._target.shows(texels.direction), texels.solid_angle, 0.0)
        uv, sheet = self._target.uv_from_direction(texels.direction)
        size = np.array([self._width, self._height])[:, None, None, None]
        centre = np.multiply(np.moveaxis(uv, -1, 0), size, order="C")
        edges = np.empty((2, *centre.shape))
        for edge, axis in zip(edges, (1, 0), strict=True):
            self._measure(edge, centre, sheet, axis)
        extent = np.abs(edges[0]) + np.abs(edges[1])
        coarse = np.maximum(extent[0], extent[1]) > 1.0 + TIE
        if source.disk < np.inf:
            coarse |= _cut(texels.uv, np.diag(texels.step), source.disk)
        if self._target.disk < np.inf and len(self._target.sheets) > 1:
            coarse |= _cut(uv, np.moveaxis(edges, 1, -1) / self._width, self._target.disk)
        coarse &= weight > 0.0
        if quarterings:
            yield from self._of_quarters(source, texels, coarse, quarterings)
            weight[coarse] = 0.0
        extent[:, coarse] = 0.0
        yield from self._of_parallelograms(
            centre.reshape(2, -1),
            edges.reshape(2, 2, -1),
            extent.reshape(2, -1),
            sheet.ravel(),
            weight.ravel(),
            texels.radiance.reshape(len(self.power), -1),
        )

    def _of_quarters(
        self, source: Representation, texels: _Texels, chosen: NDArray[np.bool], quarterings: int
    ) -> Shares:
        """Shares of some of `texels`, as four each."""
        quarter = 0.25 * texels.step * np.array([[(-1.0, -1.0), (1.0, -1.0)], [(-1.0, 1.0), (1.0, 1.0)]])
        quarter = quarter[:, :, None]
        uv, sheet = texels.uv[chosen], texels.sheet[chosen]
        solid_angle, radiance = texels.solid_angle[chosen], texels.radiance[:, chosen]
        for first in range(0, len(uv), BLOCK // 4):
            block = slice(first, first + BLOCK // 4)

            centres, on_sheet = _four(uv[block]) + quarter, _four(sheet[block])
            # A texel that the rim of a disk cuts contributes only with its parts within the disk.
            counts = np.hypot(*np.moveaxis(2.0 * centres - 1.0, -1, 0)) < source.disk
            counts |= ~counts.any(axis=(0, 1), keepdims=True)
            share = _four(solid_angle[block]) * counts / counts.sum(axis=(0, 1), keepdims=True)
            parts = _Texels(
                centres,
                source.direction_from_uv(centres, on_sheet),
                on_sheet,
                0.5 * texels.step,
                share,
                np.moveaxis(_four(radiance[:, block].T), -1, 0),
            )
            yield from self._of_grids(source, parts, quarterings - 1)

    def _measure(self, edge: Array, centre: Array, sheet: Indices, axis: int) -> None:
        """Fill in the `edge` of each texel from one side to the other along an axis of the grid.

        The mean of the ways to its two neighbours; across a seam of the target there is no way.
        """
        along = (slice(None),) * axis
        later, earlier = (*along, slice(1, None)), (*along, slice(None, -1))
        first, middle = (*along, slice(None, 1)), (*along, slice(1, -1))
        way = centre[:, *later] - centre[:, *earlier]
        known = sheet[later] == sheet[earlier]
        for distance, size in zip(way, (self._width, self._height), strict=True):
            known &= np.abs(distance) <= 0.5 * size
        way *= known
        edge[:, *first] = 0.0
        edge[:, *later] = way
        edge[:, *earlier] += way
        if known.all():
            edge[:, *middle] *= 0.5
        else:
            count = np.zeros(sheet.shape)
            count[later] = known
            count[earlier] += known
            edge /= np.maximum(count, 1.0)

    def _of_parallelograms(
        self, centre: Array, edges: Array, extent: Array, sheet: Indices, weight: Array, radiance: Array
    ) -> Shares:
        """Shares of M parallelograms.

        Parameters
        ----------
        centre : ndarray, shape (2, M)
            x and y in texels.
        edges : ndarray, shape (2, 2, M)
            Two vectors of x and y.
        extent : ndarray, shape (2, M)
            Width and height of the parallelogram along x and y, at most 1.
        sheet : ndarray of int, shape (M,)
        weight : ndarray, shape (M,)
            [sr]
        radiance : ndarray, shape (channels, M)
        """
        # Whole numbers, as float64 until they are indices: that is the faster arithmetic.
        texel = np.minimum(np.floor(centre), [[self._width - 1.0], [self._height - 1.0]])
        own = ((sheet * self._height + texel[1]) * self._width + texel[0]).astype(np.intp)
        # So small a parallelogram crosses at most one line beside its centre and one above or below.
        within = centre - texel
        distance = np.minimum(within, 1.0 - within)
        reaches = distance < 0.5 * extent
        some = np.flatnonzero((reaches[0] | reaches[1]) & (weight > 0.0))
        side = np.copysign(1.0, np.take(within, some, axis=-1) - 0.5)
        parts = parts_beyond(np.take(distance, some, axis=-1), side * np.take(edges, some, axis=-1))
        moved = np.take(weight, some) * parts
        weight[some] -= moved.sum(axis=0)
        yield own, weight, weight * radiance
        texel, sheet, own = (np.take(of, some, axis=-1) for of in (texel, sheet, own))
        for (right, up), amount in zip(((1, 0), (0, 1), (1, 1)), moved, strict=True):
            going = np.flatnonzero(amount)
            beside = np.take(texel, going, axis=-1) + np.take(side, going, axis=-1) * [[right], [up]]
            column, row = beside.astype(np.intp)
            other = self._texel(column, row, np.take(sheet, going), np.take(own, going))
            share = np.take(amount, going)
            yield other, share, share * np.take(radiance, np.take(some, going), axis=-1)

    def _texel(self, column: Indices, row: Indices, sheet: Indices, otherwise: Indices) -> Indices:
        """Number of a texel, beyond a sheet's edge too; `otherwise` where none is, or none that counts."""
        texel = (sheet * self._height + row) * self._width + column
        outside = np.flatnonzero((column < 0) | (column >= self._width) | (row < 0) | (row >= self._height))
        if outside.size:
            column, row, sheet = self._target.wrap(
                column[outside], row[outside], sheet[outside], self._width, self._height
            )
            found = (sheet * self._height + row) * self._width + column
            texel[outside] = np.where(sheet < 0, otherwise[outside], found)
        return np.where(self._counts[texel], texel, otherwise)


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


def _four(values: NDArray[Scalar]) -> NDArray[Scalar]:
    """Each of K values four times, shape (2, 2, K, ...)."""
    return np.broadcast_to(values, (2, 2, *values.shape))


def _cut(uv: Array, edges: Array, disk: float) -> NDArray[np.bool]:
    """Whether the rim of a disk cuts parallelograms around points of a sheet, given their two edges."""
    from_middle = uv - 0.5
    distance = np.linalg.norm(from_middle, axis=-1)
    reach = 0.5 * (np.abs(dot(edges[0], from_middle)) + np.abs(dot(edges[1], from_middle)))
    cut: NDArray[np.bool] = np.abs(distance - 0.5 * disk) * distance < reach
    return cut
