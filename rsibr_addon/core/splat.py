"""The power of one map, splatted onto the texels of another by the area that they share.

A texel has constant radiance over its solid angle. On a sheet of another map it is nearly a parallelogram:
its middle is where its centre falls, and its edges reach half-way to its neighbours' centres. Its solid angle
is divided exactly among the texels beneath, by the parts of the parallelogram that lie on each. A texel that
is larger than those beneath is quartered until it is not. All of it goes somewhere, so power is kept to the
last digits in all maps.

Where quarter turns about z and mirrors take texels of both maps to texels, one sector of sixteen is divided
for all: the others' shares are the same, of turned or mirrored texels.
"""

import itertools
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from .conventions import Array, Indices
from .geometry.directions import dot
from .maps.representation import WORLD, Representation, Sectors
from .parallelograms import parts_beyond
from .threads import in_order
from .ties import TIE

Scalar = TypeVar("Scalar", bound=np.generic)

TILE = 192
"""Rows and columns of a map at a time, so that their data stay in a processor's cache however large it is."""

BLOCK = TILE**2
"""Texels at a time where they do not make a tile."""

Shares = Iterator[tuple[Indices, Indices, Array]]
"""Numbers of texels in a tile, numbers of texels of the target, and the solid angles [sr] that these get of
those; of shape (M,) each."""

Sums = tuple[Indices, Array, Array]
"""Different texels of the target by their numbers, shape (M,), and what these get: solid angles, shape (M,),
and powers, shape (channels, M)."""

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
    number : ndarray of int, shape (rows, columns, grids)
        Which texel of its tile it is, or is a part of.
    """

    uv: Array
    direction: Array
    sheet: Indices
    step: Array
    solid_angle: Array
    number: Indices


class _Runs:
    """Shares, summed over neighbours that go to one texel: most do where texels are much smaller.

    Attributes
    ----------
    other : ndarray of int, shape (N,)
        The texels of the target.
    """

    def __init__(self, texel: Indices, other: Indices, solid_angle: Array) -> None:
        # Without gaps they need not be gathered
        whole = np.array_equal(texel, np.arange(len(texel)))
        self._texel = slice(len(texel)) if whole else texel
        self._weight = solid_angle
        first = np.flatnonzero(np.diff(other, prepend=-1))
        self._first = first if 2 * len(first) < len(other) else None
        self.other = other if self._first is None else other[first]

    def solid_angle(self) -> Array:
        """What they get [sr], shape (N,)."""
        return self._summed(self._weight)

    def power(self, radiance: Array) -> Array:
        """What they get, shape (N,), of the radiance of a tile's texels, shape (M,)."""
        return self._summed(self._weight * radiance[self._texel])

    def _summed(self, values: Array) -> Array:
        return values if self._first is None else np.add.reduceat(values, self._first)


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
        sectors: Sectors = [(WORLD, image)]
        if self._target.is_symmetric(self._width):
            sectors = source.sectors(image)
        sheets, height, width = sectors[0][1].shape[:3]
        solid_angle = source.texel_solid_angle(image.shape[2])
        corners = itertools.product(range(sheets), range(0, height, TILE), range(0, width, TILE))
        for of_sectors in in_order(partial(self._of_tile, source, solid_angle, sectors), corners):
            for number, got, power in of_sectors:
                self.solid_angle[number] += got
                for sums, values in zip(self.power, power, strict=True):
                    sums[number] += values

    def _of_tile(
        self, source: Representation, solid_angle: Array, sectors: Sectors, corner: tuple[int, int, int]
    ) -> list[Sums]:
        """Sums over the texels of a tile of the first sector, and of those in its place in the others."""
        sheet, row, column = corner
        radiance = [image[sheet, row : row + TILE, column : column + TILE] for _, image in sectors]
        texels = _tile_of(source, solid_angle, corner, radiance[0].shape[:2])
        shares = [_Runs(*share) for share in self._of_grids(source, texels, DEEPEST)]
        number, places = _numbered([runs.other for runs in shares], self._counts.size)

        def total(sums: Iterable[Array]) -> Array:
            collected = np.zeros(len(number))
            for place, values in zip(places, sums, strict=True):
                np.add.at(collected, place, values)
            return collected

        got = total(runs.solid_angle() for runs in shares)
        others = [number]
        if len(sectors) > 1:
            matrices = np.array([matrix for matrix, _ in sectors[1:]])
            others.extend(self._target.turned_texels(number, self._width, matrices))
        made = []
        for other, of_sector in zip(others, radiance, strict=True):
            channels = (
                np.moveaxis(of_sector, -1, 0).astype(np.float64, order="C").reshape(len(self.power), -1)
            )
            power = [total(runs.power(channel) for runs in shares) for channel in channels]
            made.append((other, got, np.stack(power)))
        return made

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
        some = np.flatnonzero(weight)
        yield from self._of_parallelograms(
            np.take(centre.reshape(2, -1), some, axis=-1),
            np.take(edges.reshape(2, 2, -1), some, axis=-1),
            np.take(extent.reshape(2, -1), some, axis=-1),
            np.take(sheet, some),
            np.take(weight, some),
            np.take(texels.number, some),
        )

    def _of_quarters(
        self, source: Representation, texels: _Texels, chosen: NDArray[np.bool], quarterings: int
    ) -> Shares:
        """Shares of some of `texels`, as four each."""
        quarter = 0.25 * texels.step * np.array([[(-1.0, -1.0), (1.0, -1.0)], [(-1.0, 1.0), (1.0, 1.0)]])
        quarter = quarter[:, :, None]
        uv, sheet = texels.uv[chosen], texels.sheet[chosen]
        solid_angle, number = texels.solid_angle[chosen], texels.number[chosen]
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
                _four(number[block]),
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
        self, centre: Array, edges: Array, extent: Array, sheet: Indices, weight: Array, number: Indices
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
            [sr], above 0
        number : ndarray of int, shape (M,)
            See `_Texels`.
        """
        # Whole numbers, as float64 until they are indices: that is the faster arithmetic.
        texel = np.minimum(np.floor(centre), [[self._width - 1.0], [self._height - 1.0]])
        own = ((sheet * self._height + texel[1]) * self._width + texel[0]).astype(np.intp)
        # So small a parallelogram crosses at most one line beside its centre and one above or below.
        within = centre - texel
        distance = np.minimum(within, 1.0 - within)
        reaches = distance < 0.5 * extent
        some = np.flatnonzero(reaches[0] | reaches[1])
        side = np.copysign(1.0, np.take(within, some, axis=-1) - 0.5)
        parts = parts_beyond(np.take(distance, some, axis=-1), side * np.take(edges, some, axis=-1))
        moved = np.take(weight, some) * parts
        weight[some] -= moved.sum(axis=0)
        yield number, own, weight
        texel, sheet, own, number = (np.take(of, some, axis=-1) for of in (texel, sheet, own, number))
        for (right, up), amount in zip(((1, 0), (0, 1), (1, 1)), moved, strict=True):
            going = np.flatnonzero(amount)
            beside = np.take(texel, going, axis=-1) + np.take(side, going, axis=-1) * [[right], [up]]
            column, row = beside.astype(np.intp)
            other = self._texel(column, row, np.take(sheet, going), np.take(own, going))
            yield np.take(number, going), other, np.take(amount, going)

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


def _tile_of(
    source: Representation, solid_angle: Array, corner: tuple[int, int, int], shape: tuple[int, int]
) -> _Texels:
    """Texels of a map, of given solid angles: a grid of some shape from a sheet, row and column onwards.

    With a rim of texels more, of no solid angle: edges are known from both neighbours.
    """
    sheet, *first = corner
    _, *size = solid_angle.shape
    rows, columns = (
        np.arange(start - 1, start + count + 1)
        if source.own_grid
        else np.arange(max(start - 1, 0), min(start + count + 1, end))
        for start, count, end in zip(first, shape, size, strict=True)
    )
    u, v = (columns + 0.5) / size[1], (rows + 0.5) / size[0]
    own, in_map = (
        tuple(slice(start, start + count) for start, count in zip(at, shape, strict=True))
        for at in ((first[0] - rows[0], first[1] - columns[0]), first)
    )
    weight, number = np.zeros((len(v), len(u), 1)), np.zeros((len(v), len(u), 1), dtype=np.intp)
    weight[own] = solid_angle[sheet, *in_map, None]
    number[own] = np.arange(shape[0] * shape[1]).reshape(*shape, 1)
    return _Texels(
        np.stack(np.broadcast_arrays(u, v[:, None]), axis=-1)[:, :, None],
        source.direction_of_grid(u, v, sheet)[:, :, None],
        np.full(weight.shape, sheet),
        np.array([1.0 / size[1], 1.0 / size[0]]),
        weight,
        number,
    )


def _numbered(lists: Sequence[Indices], count: int) -> tuple[Indices, list[Indices]]:
    """Different numbers of several lists, all below `count`, and the places among them of each list's."""
    numbers = np.concatenate(lists)
    # Whichever writes last into a number's place stands for all that are equal
    last = np.empty(count, dtype=np.intp)
    each = np.arange(len(numbers))
    last[numbers] = each
    stands_for = last[numbers]
    chosen = stands_for == each
    place = (np.cumsum(chosen) - 1)[stands_for]
    return numbers[chosen], np.split(place, np.cumsum([len(numbers) for numbers in lists[:-1]]))


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
