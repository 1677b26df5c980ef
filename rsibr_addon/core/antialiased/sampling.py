"""Lookups spread over what a pixel reflects, as many as it takes to find every texel.

[Miller1984] section 8 integrates a table over a pixel's footprint. Maps of other kinds are no tables of one
direction: what they show by a direction is a blend of several maps. But they are smooth between texels, so
lookups that are a texel apart miss nothing, and where a pixel reflects less than a texel one is enough.
"""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ..conventions import Array, ArrayLike, Indices
from ..geometry.directions import normalize

MOST = 4
"""Lookups along each side of a pixel: sixteen at most, where a surface is wrinkled to the size of pixels."""


def sample_counts(across: ArrayLike, up: ArrayLike, texel_angle: ArrayLike) -> Indices:
    """How many lookups a pixel takes along its sides.

    Parameters
    ----------
    across, up : array_like, shape (..., 3)
        Sides of the footprint.
    texel_angle : array_like, shape (...,)
        Square root of the solid angle of a texel there.

    Returns
    -------
    ndarray of int, shape (..., 2)
        1 to `MOST` along `across`, and along `up`: no more than a texel from one to the next, while `MOST`
        allows.

    Notes
    -----
    GLSL twin: gpu_shaders/lib/footprint_lib.glsl `sample_counts`; a side within a rounding of whole texels
    may differ by one.
    """
    sides = np.linalg.norm(np.stack([across, up], axis=-2), axis=-1)
    counts: Indices = np.clip(np.ceil(sides / np.asarray(texel_angle)[..., None]), 1, MOST).astype(np.intp)
    return counts


def sample_direction(
    middle: ArrayLike, across: ArrayLike, up: ArrayLike, counts: ArrayLike, number: int
) -> Array:
    """One of the directions that a pixel is looked up by.

    Parameters
    ----------
    middle, across, up : array_like, shape (..., 3)
        As of `footprint.parallelogram`.
    counts : array_like of int, shape (..., 2)
        See `sample_counts`.
    number : int
        From 0 to the product of the counts, less 1: row by row, in the middles of as many equal parts.

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
        The pixels that have one more.
    direction : ndarray, shape (n, 3)
        Theirs.
    weight : ndarray, shape (n, 1)
        One over the number of lookups: over all, a pixel's add up to 1.
    """
    number_of = np.prod(counts, axis=-1)
    for number in range(int(number_of.max(initial=0))):
        chosen = number < number_of
        direction = sample_direction(middle[chosen], across[chosen], up[chosen], counts[chosen], number)
        yield chosen, direction, 1.0 / number_of[chosen][:, None]
