"""Six photographs of a cube's faces made to agree along its edges."""

import itertools

import numpy as np

from ..conventions import Array, Indices
from ..errors import RangeError
from ..maps import cube_map

MOST_GAIN = 64.0
"""Greatest gain: photographs that seem to differ by more show different things."""


def edge_pairs(cube: Array) -> tuple[Indices, Indices, Array, Array]:
    """Texels on either side of the cube's edges.

    Parameters
    ----------
    cube : ndarray, shape (6, size, size, channels)

    Returns
    -------
    face, other : ndarray of int, shape (24 size,)
        Numbers of the faces; each edge appears from both sides.
    texel, across : ndarray, shape (24 size, channels)
        The last texel of `face`, and the first of `other`.
    """
    size = cube.shape[1]
    along = np.tile(np.arange(size), 4)
    inside = np.repeat([0, size - 1, 0, size - 1], size)
    outside = np.repeat([-1, size, -1, size], size)
    by_row = np.repeat([False, False, True, True], size)
    columns, rows = np.where(by_row, along, inside), np.where(by_row, inside, along)
    next_columns, next_rows = np.where(by_row, along, outside), np.where(by_row, outside, along)
    face = np.repeat(np.arange(6), 4 * size)
    columns, rows, next_columns, next_rows = (np.tile(a, 6) for a in (columns, rows, next_columns, next_rows))
    other_columns, other_rows, other = cube_map.wrap(next_columns, next_rows, face, size, size)
    return face, other, cube[face, rows, columns], cube[other, other_rows, other_columns]


def balancing_gains(cube: Array, white: float) -> Array:
    """Factors that make the faces of a cube agree along its edges.

    Parameters
    ----------
    cube : ndarray, shape (6, size, size, channels)
        Radiance, each face up to factors of its own.
    white : float
        Values from this on are taken for saturated and count nothing; infinite if none are.

    Returns
    -------
    ndarray, shape (6, channels), float64
        Positive; their geometric mean is 1 in each channel.

    Raises
    ------
    RangeError
        Too few texels of the edges are neither black nor white.

    Notes
    -----
    For each channel, weighted least squares in the logarithm: the median ratio across each of the twelve
    edges shall be the inverse ratio of the gains. It takes a median because things near the camera do not
    meet across an edge.
    """
    face, other, texel, across = edge_pairs(cube)
    usable = (texel > 0.0) & (across > 0.0) & (texel < white) & (across < white)
    gains = np.empty((6, cube.shape[-1]))
    for channel in range(cube.shape[-1]):
        chosen = usable[:, channel]
        ratio = across[chosen, channel] / texel[chosen, channel]
        gains[:, channel] = np.exp(_logarithms(face[chosen], other[chosen], np.log(ratio)))
    return gains


def _logarithms(face: Indices, other: Indices, difference: Array) -> Array:
    """Logarithms of the gains, shape (6,), by those of the ratios across edges."""
    rows, wanted = [np.ones(6)], [0.0]
    for first, second in itertools.combinations(range(6), 2):
        edge = (face == first) & (other == second)
        if np.any(edge):
            weight = np.sqrt(np.count_nonzero(edge))
            row = np.zeros(6)
            row[first], row[second] = weight, -weight
            rows.append(row)
            wanted.append(weight * float(np.median(difference[edge])))
    logarithms: Array
    logarithms, _, rank, _ = np.linalg.lstsq(np.array(rows), np.array(wanted), rcond=None)
    if rank < 6 or np.abs(logarithms).max() > np.log(MOST_GAIN):
        raise RangeError(
            "The faces cannot be balanced, because too few texels on their edges are neither black nor "
            "white: photograph them with one exposure, and leave the balance out."
        )
    return logarithms
