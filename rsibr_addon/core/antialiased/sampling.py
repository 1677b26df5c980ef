"""Lookups spread over what a pixel reflects, as many as it takes to find every texel.

[Miller1984] section 8 integrates a table over a pixel's footprint. Maps of other kinds are no tables over one
direction: they blend several maps. But they are smooth between texels, so lookups a texel apart miss nothing,
and where a pixel reflects less than a texel one lookup is enough.
"""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ..conventions import Array, ArrayLike, Indices
from ..geometry.directions import normalize

MOST = 4
"""Most lookups along each side of a pixel: sixteen in all, where wrinkles are as small as pixels."""


def sample_counts(across: ArrayLike, up: ArrayLike, texel_angle: ArrayLike, most: int = MOST) -> Indices:
    """Numbers of lookups of a pixel along its sides.

    Parameters
    ----------
    across, up : array_like, shape (..., 3)
        Sides of the footprint.
    texel_angle : array_like, shape (...,)
        Square root of the solid angle of a texel there.
    most : int

    Returns
    -------
    ndarray of int, shape (..., 2)
        1 to `most` along `across`, and along `up`: at most a texel from one to the next, as far as `most`
        allows.

    Notes
    -----
    GLSL twin: gpu_shaders/lib/footprint_lib.glsl `sample_counts`; a side within a rounding of whole texels
    may differ by one.
    """
    sides = np.linalg.norm(np.stack([across, up], axis=-2), axis=-1)
    counts: Indices = np.clip(np.ceil(sides / np.asarray(texel_angle)[..., None]), 1, most).astype(np.intp)
    return counts


def sample_direction(
    middle: ArrayLike, across: ArrayLike, up: ArrayLike, counts: ArrayLike, number: int
) -> Array:
    """One of the directions that a pixel is looked up by.

    Parameters
    ----------
    middle, across, up : array_like, shape (..., 3)
        See `footprint.parallelogram`.
    counts : array_like of int, shape (..., 2)
        See `sample_counts`.
    number : int
        From 0 to the product of the counts, less 1: row by row, in the middles of equal parts.

    Returns
    -------
    ndarray, shape (..., 3)
        Unit directions.

    Notes
    -----
    GLSL twin: gpu_shaders/lib/footprint_lib.glsl `sample_direction`, 1e-6.
    """
    counts = np.asarray(counts)
    row, column = np.divmod(number, counts[..., 0])
    place = (np.stack([column, row], axis=-1) + 0.5) / counts - 0.5
    return normalize(middle + place[..., :1] * np.asarray(across) + place[..., 1:] * np.asarray(up))


def samples(
    middle: Array, across: Array, up: Array, counts: Indices
) -> Iterator[tuple[NDArray[np.bool], Array, Array]]:
    """All directions that pixels are looked up by, one of each pixel at a time.

    Parameters
    ----------
    middle, across, up : ndarray, shape (..., 3)
    counts : ndarray of int, shape (..., 2)
        See `sample_direction`.

    Yields
    ------
    chosen : ndarray of bool, shape (...,)
        The pixels that have a further lookup.
    direction : ndarray, shape (n, 3)
        The directions of these pixels.
    weight : ndarray, shape (n, 1)
        One over the pixel's number of lookups, so that a pixel's weights add up to 1.
    """
    number_of = np.prod(counts, axis=-1)
    for number in range(int(number_of.max(initial=0))):
        chosen = number < number_of
        direction = sample_direction(middle[chosen], across[chosen], up[chosen], counts[chosen], number)
        yield chosen, direction, 1.0 / number_of[chosen][:, None]
