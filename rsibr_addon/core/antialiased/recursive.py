"""Recursive subdivision of the pixel, [Miller1984] section 8.1."""

import numpy as np
from numpy.typing import NDArray

from ..conventions import Array, ArrayLike, Indices
from ..geometry.directions import normalize
from ..maps import equirect

SMALLEST = 0.5
"""Part of a texel's height; a region whose sides are all shorter is not divided further."""

AGREEMENT = 0.01
"""Part of the larger of two adjacent table entries by which they may differ and still agree."""

BLOCK = 1 << 10
"""Footprints divided at once: each may become thousands of regions."""


def table_entry(radiance: Array, direction: ArrayLike) -> tuple[Indices, Indices]:
    """Column and row of the texel that a direction falls on.

    Parameters
    ----------
    radiance : ndarray, shape (height, width, channels)
        An equirectangular table.
    direction : array_like, shape (..., 3)
        Unit directions.

    Returns
    -------
    columns, rows : ndarray of int, shape (...,)
    """
    height, width = radiance.shape[:2]
    uv = equirect.uv_from_direction(direction)
    columns, rows = (np.floor(uv[..., i] * size).astype(np.intp) for i, size in enumerate((width, height)))
    return columns % width, np.minimum(rows, height - 1)


def recursive_mean(radiance: Array, corners: ArrayLike) -> Array:
    """Mean of a table over pixels' footprints, each pixel divided until lookups agree.

    Parameters
    ----------
    radiance : ndarray, shape (height, width, channels)
        An equirectangular table.
    corners : array_like, shape (..., 4, 3)
        Unit directions in order around the pixel; no neighbours opposite to each other.

    Returns
    -------
    ndarray, shape (..., channels), float64
        The mean over the pixel's area, not over its solid angle: a box filter of the picture.

    Notes
    -----
    [Miller1984] section 8.1: a region is halved across its longer sides until its four corners index the same
    table entry or adjacent ones; then it takes their mean. We also ask that adjacent entries agree: by the
    paper's rule alone a lamp of one texel is off by a quarter of a region. The cost grows with the number of
    texels that the footprint covers. No GLSL twin.
    """
    corners = np.asarray(corners, dtype=np.float64)
    regions = corners.reshape(-1, 4, 3)
    mean = np.empty((len(regions), radiance.shape[-1]))
    for first in range(0, len(regions), BLOCK):
        mean[first : first + BLOCK] = _block_mean(radiance, regions[first : first + BLOCK])
    return mean.reshape(*corners.shape[:-2], radiance.shape[-1])


def _block_mean(radiance: Array, region: Array) -> Array:
    pixel = np.arange(len(region))
    mean = np.zeros((len(region), radiance.shape[-1]))
    share = 1.0
    while len(region):
        columns, rows = table_entry(radiance, region)
        done = _agree(radiance, columns, rows) | _small(region, radiance.shape[0])
        np.add.at(mean, pixel[done], share * np.mean(radiance[rows[done], columns[done]], axis=1))
        region, pixel = _halves(region[~done]), np.tile(pixel[~done], 2)
        share *= 0.5
    return mean


def _agree(radiance: Array, columns: Indices, rows: Indices) -> NDArray[np.bool]:
    """Whether regions' corners lie in two by two texels, across the seam too, whose entries agree."""
    width = radiance.shape[1]
    ahead = (columns - columns[:, :1] + width // 2) % width
    agree: NDArray[np.bool] = (np.ptp(ahead, axis=1) <= 1) & (np.ptp(rows, axis=1) <= 1)
    left = (np.min(ahead[agree], axis=1) + columns[agree, 0] - width // 2) % width
    right = (np.max(ahead[agree], axis=1) + columns[agree, 0] - width // 2) % width
    low, high = np.min(rows[agree], axis=1), np.max(rows[agree], axis=1)
    block = np.stack([radiance[row, column] for row in (low, high) for column in (left, right)])
    agree[agree] = np.all(np.ptp(block, axis=0) <= AGREEMENT * np.max(np.abs(block), axis=0), axis=-1)
    return agree


def _small(region: Array, height: int) -> NDArray[np.bool]:
    sides = np.linalg.norm(region - np.roll(region, -1, axis=1), axis=-1)
    small: NDArray[np.bool] = np.max(sides, axis=1) < SMALLEST * np.pi / height
    return small


def _halves(region: Array) -> Array:
    """All first halves, then all second ones; cut across the pair of sides that has the longest."""
    sides = np.linalg.norm(region - np.roll(region, -1, axis=1), axis=-1)
    upright = np.argmax(sides, axis=1) % 2 == 1
    # Turned by a corner, so that sides 0 and 2 are always the ones to be cut.
    region = np.where(upright[:, None, None], np.roll(region, -1, axis=1), region)
    a, b, c, d = np.moveaxis(region, 1, 0)
    ab, cd = normalize(a + b), normalize(c + d)
    return np.concatenate([np.stack([a, ab, cd, d], axis=1), np.stack([ab, b, c, cd], axis=1)])
