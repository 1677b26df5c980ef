"""Lookups in maps between texels, and conversion of any map to any other."""

from collections.abc import Callable

import numpy as np
from numpy.typing import DTypeLike, NDArray

from .conventions import Array, ArrayLike, Indices
from .errors import ShapeError
from .maps.representation import Representation
from .splat import BLOCK, Splat
from .threads import in_order

Wrap = Callable[[Indices, Indices, int, int], tuple[Indices, Indices]]
"""`wrap` of a map representation: from texel indices beyond the edge to the texels that are there."""


def bilinear(image: Array, uv: ArrayLike, wrap: Wrap, layer: Indices | None = None) -> Array:
    """Bilinear interpolation between texel centres, across the map's seams.

    Parameters
    ----------
    image : ndarray, shape ([layers,] height, width, channels)
        The map, or several of one size; row 0 at the bottom.
    uv : array_like, shape (..., 2)
        Map coordinates.
    wrap : callable
        The map representation's own `wrap`.
    layer : ndarray of int, broadcastable to uv's shape (...,), optional
        Number of the map to look up, of several.

    Returns
    -------
    ndarray, shape (..., channels), float64

    Notes
    -----
    The same as in graphics hardware, but at full precision: hardware may round the weights to 1/256.
    """
    height, width = image.shape[-3:-1]
    columns, rows, weights = _four_texels(uv, width, height)
    columns, rows = wrap(columns, rows, width, height)
    texels = image[rows, columns] if layer is None else image[layer, rows, columns]
    return _weighted_sum(weights, texels)


def clamp_to_edge(columns: Indices, rows: Indices, width: int, height: int) -> tuple[Indices, Indices]:
    """The texels to take for those beyond a picture's edges, which has no neighbour: see `bilinear`.

    Parameters
    ----------
    columns, rows : ndarray of int, any shape
    width, height : int
        Of the picture.

    Returns
    -------
    columns, rows : ndarray of int
        Within the picture.
    """
    return np.clip(columns, 0, width - 1), np.clip(rows, 0, height - 1)


def lookup(image: Array, direction: ArrayLike, representation: Representation) -> Array:
    """Radiance of a map in given directions, bilinear between texel centres, across all seams.

    Parameters
    ----------
    image : ndarray, shape (sheets, height, width, channels)
        The map.
    direction : array_like, shape (..., 3)
        Unit directions in world coordinates.
    representation : Representation
        How the map is laid out.

    Returns
    -------
    ndarray, shape (..., channels), float64

    Notes
    -----
    Continuous over the sphere for equirect, cube and octahedral maps. At a cube's corners, where only three
    texels meet, their mean is the fourth, as in OpenGL's seamless filtering. At a disk's rim it is as
    continuous as the map's content.
    """
    height, width = image.shape[1:3]
    columns, rows, sheets, weights = texels_around(direction, representation, width, height)
    if not image.flags.c_contiguous:
        return _weighted_sum(weights, image[sheets, rows, columns])
    # One number for each texel is looked up four times as fast as three
    texel = (sheets * height + rows) * width + columns
    return _weighted_sum(weights, image.reshape(-1, image.shape[-1]).take(texel, axis=0))


def lookup_variance(solid_angle: float) -> float:
    """Mean variance that bilinear lookups of nearly square texels add along each of two axes [rad^2].

    Parameters
    ----------
    solid_angle : float
        Of a texel [sr].

    Notes
    -----
    At p between two centres they weigh 1 - p and p, of variance p (1 - p): a sixth, on average.
    """
    return solid_angle / 6.0


def texels_around(
    direction: ArrayLike, representation: Representation, width: int, height: int
) -> tuple[Indices, Indices, Indices, Array]:
    """Columns, rows, sheets and weights of the four texels that `lookup` takes, each of shape (4, ...).

    Parameters
    ----------
    direction : array_like, shape (..., 3)
    representation : Representation
    width, height : int
        Of a sheet in texels.
    """
    uv, sheet = representation.uv_from_direction(direction)
    columns, rows, weights = _four_texels(uv, width, height)
    columns, rows, sheets = representation.wrap(
        columns, rows, np.broadcast_to(sheet, columns.shape), width, height
    )
    missing = sheets < 0
    if not missing.any():
        return columns, rows, sheets, weights
    shared = np.sum(weights * missing, axis=0) / 3.0
    return columns, rows, sheets, np.where(missing, 0.0, weights + shared)


def bordered(image: Array, representation: Representation) -> Array:
    """A map whose sheets have a border of one texel, which continues them for bilinear lookups by hardware.

    Parameters
    ----------
    image : ndarray, shape (sheets, height, width, channels)
    representation : Representation
        Of no cube: three texels meet at its corners.

    Returns
    -------
    ndarray, shape (sheets, height + 2, width + 2, channels)
        Of the type of `image`; (u, v) is at (u * width + 1) / (width + 2), and v likewise.
    """
    sheets, height, width, channels = image.shape
    whole = np.empty((sheets, height + 2, width + 2, channels), image.dtype)
    whole[:, 1:-1, 1:-1] = image
    row, column = np.nonzero(np.pad(np.zeros((height, width), dtype=bool), 1, constant_values=True))
    sheet = np.broadcast_to(np.arange(sheets)[:, None], (sheets, len(row)))
    beyond_column, beyond_row = (np.broadcast_to(each - 1, sheet.shape) for each in (column, row))
    columns, rows, on = representation.wrap(beyond_column, beyond_row, sheet, width, height)
    whole[:, row, column] = image[on, rows, columns]
    return whole


def resample(
    image: Array, source: Representation, target: Representation, size: int, dtype: DTypeLike = np.float64
) -> Array:
    """The same light in another representation or size.

    A map of fewer texels gets the mean radiance over each of its texels, with the old texels constant over
    their solid angles: `splat`. A map of as many texels or more is interpolated: `lookup`.

    Parameters
    ----------
    image : ndarray, shape (sheets, height, width, channels)
        Radiance, laid out as `source`.
    source, target : Representation
    size : int
        Width of the new map's sheets in texels.
    dtype : dtype
        Type of the new map: single precision halves the memory of the largest.

    Returns
    -------
    ndarray, shape (sheets, height, width, channels), `dtype`
        Laid out as `target`. Every texel can be looked up, those outside a disk too; a blind spot of the old
        map repeats its edge.

    Raises
    ------
    RangeError
        No map of `target` is so wide.
    ShapeError
        `image` is not laid out as `source`.

    Notes
    -----
    A constant map stays constant to 1e-12. Of means, the total power is the old map's to 1e-12 unless
    either has a blind spot: the splat keeps it, but divides it by solid angles that are off by some
    1e-4 of each, which one factor for each channel makes up for.
    """
    shape = target.shape(size)
    if image.ndim != 4 or image.shape[:3] != source.shape(image.shape[2]):
        raise ShapeError(f"A {source.name} map cannot have the shape {image.shape}: check its layout.")
    if _shown(target, size) >= _shown(source, image.shape[2]):
        made = np.empty((*shape, image.shape[-1]), dtype)
        _fill(made, None, image, source, target)
        return made
    splat = Splat(target, size, image.shape[-1])
    splat.lay_down(image, source)
    got, after = splat.solid_angle > 0.0, splat.texel_solid_angle
    made = (splat.power / np.where(got, splat.solid_angle, 1.0)).T.reshape(*shape, -1)
    _fill(made, ~got.reshape(shape), image, source, target)
    if source.blind_angle == target.blind_angle == 0.0:
        _restore_power(made, after, splat.power.sum(axis=1))
    if target.goes_on:
        _fill(made, after == 0.0, made.copy(), target, target)
    else:
        _repeat_rim(made, after == 0.0)
    return made.astype(dtype, copy=False)


def _shown(layout: Representation, size: int) -> int:
    """How many texels of a map show light."""
    if np.isinf(layout.disk):
        return int(np.prod(layout.shape(size)))
    return int(np.count_nonzero(layout.texel_solid_angle(size)))


def _restore_power(made: Array, solid_angle: Array, power: Array) -> None:
    """Scale a map's radiance, channel by channel, to a given total power; negative radiance the other way."""
    missing = power - np.einsum("shw,shwc->c", solid_angle, made)
    absolute = np.einsum("shw,shwc->c", solid_angle, np.abs(made))
    made += np.abs(made) * (missing / np.where(absolute > 0.0, absolute, 1.0))


def _fill(
    made: Array, where: NDArray[np.bool] | None, image: Array, source: Representation, target: Representation
) -> None:
    """Fill chosen texels of a map, or all, with another map's radiance at their centres."""
    shape = made.shape[:-1]
    _, height, width = shape
    chosen = None if where is None else np.flatnonzero(where)
    count = made[..., 0].size if chosen is None else len(chosen)
    flat = made.reshape(-1, made.shape[-1])

    def looked_up(first: int) -> tuple[Indices, Array]:
        last = min(first + BLOCK, count)
        texel = np.arange(first, last) if chosen is None else chosen[first:last]
        sheet, row, column = np.unravel_index(texel, shape)
        uv = np.stack([(column + 0.5) / width, (row + 0.5) / height], axis=-1)
        return texel, lookup(image, target.direction_from_uv(uv, sheet), source)

    for texel, radiance in in_order(looked_up, range(0, count, BLOCK)):
        flat[texel] = radiance


def _repeat_rim(made: Array, outside: NDArray[np.bool]) -> None:
    """Fill texels outside a disk that touches the edges from its rim beside them."""
    size = made.shape[1]
    sheet, row, column = np.nonzero(outside)
    from_middle = np.stack([row, column]) + 0.5 - 0.5 * size
    # Half a texel within the rim, so that the point's texel is not outside.
    on_rim = from_middle * (0.5 * (size - 1.0) / np.linalg.norm(from_middle, axis=0))
    made[sheet, row, column] = made[sheet, *np.floor(on_rim + 0.5 * size).astype(np.intp)]


def _four_texels(uv: ArrayLike, width: int, height: int) -> tuple[Indices, Indices, Array]:
    """Columns, rows and weights of the four texels around points of a sheet, each of shape (4, ...)."""
    position = np.asarray(uv, dtype=np.float64) * (width, height) - 0.5
    corner = np.floor(position)
    fraction = position - corner
    column, row = corner[..., 0].astype(np.intp), corner[..., 1].astype(np.intp)
    right, up = fraction[..., 0], fraction[..., 1]
    left, down = 1.0 - right, 1.0 - up
    return (
        np.stack([column, column + 1, column, column + 1]),
        np.stack([row, row, row + 1, row + 1]),
        np.stack([left * down, right * down, left * up, right * up]),
    )


def _weighted_sum(weights: Array, texels: Array) -> Array:
    """Sum of four texels, shape (..., channels), float64."""
    total: Array = np.einsum("k...,k...c->...c", weights, texels)
    return total
