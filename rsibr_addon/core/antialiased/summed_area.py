"""The pre-integrated table, [Miller1984] section 8.3: means over rectangles at a constant cost, exactly.

A sum over a rectangle is a difference of four sums over everything below and to the left of its corners
[Crow1984]. Beside a sun such sums are a million times as large as the texels, and floating point would lose
these in the difference. Here every texel's radiance times solid angle is rounded once, to an integer, and
sums and differences of integers are exact.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..conventions import Array, ArrayLike, Indices
from ..errors import RangeError
from ..maps import equirect

TOTAL_BITS = 61
"""A table's total is about 2**61 of its units: two turns around it still fit a signed 64-bit integer."""


@dataclass(frozen=True)
class SummedAreaTable:
    """A latitude-longitude table, summed.

    Attributes
    ----------
    sums : ndarray, shape (height + 1, width + 1, channels), int64
        [j, i] is the sum of radiance times solid angle over the texels of the rows below j and the columns
        below i, in units of `unit`.
    unit : ndarray, shape (channels,), float64
        [radiance sr]: 2**-61 of the table's total; every texel is right to half of it.
    """

    sums: NDArray[np.int64]
    unit: Array


def summed_area_table(radiance: Array) -> SummedAreaTable:
    """Sum a table once, to be averaged over many boxes.

    Parameters
    ----------
    radiance : ndarray, shape (height, width, channels)
        An equirectangular table; a texel stands for a constant radiance over its solid angle.

    Raises
    ------
    RangeError
        A value is negative, infinite or NaN.

    Notes
    -----
    [Crow1984], weighted by solid angle, so that means are means over the sphere. A dark texel beside a sun of
    1e5, in a table of 2048x1024, keeps all digits that single precision gave it.
    """
    if not np.all(np.isfinite(radiance) & (radiance >= 0.0)):
        raise RangeError("A table to be summed holds negative, infinite or NaN values: repair it first.")
    height, width, channels = radiance.shape
    power = radiance.astype(np.float64) * equirect.texel_solid_angle(width, height)[..., None]
    total = np.sum(power, axis=(0, 1))
    unit = np.where(total > 0.0, total, 1.0) / 2.0**TOTAL_BITS
    sums = np.zeros((height + 1, width + 1, channels), dtype=np.int64)
    sums[1:, 1:] = np.cumsum(np.cumsum(np.rint(power / unit).astype(np.int64), axis=0), axis=1)
    return SummedAreaTable(sums, unit)


def box_mean(table: SummedAreaTable, box: ArrayLike) -> Array:
    """Mean radiance over rectangles of a table.

    Parameters
    ----------
    table : SummedAreaTable
    box : array_like, shape (..., 4)
        As `footprint_box` returns it: u and v of the lower left corner, u in [0, 1], v in [0, 1); u and v of
        the upper right one, above those of the lower left; u by 1 at most.

    Returns
    -------
    ndarray, shape (..., channels), float64
        The mean over solid angle; a cut texel counts in proportion to its area in the table.

    Raises
    ------
    RangeError
        A box is empty or lies outside the table.

    Notes
    -----
    [Miller1984] section 8.3. The box is split into nine blocks where it cuts texels. Each block is an exact
    sum with a weight that is not negative, so nothing cancels, and 16 texels are read. GLSL twin:
    gpu_shaders/lib/summed_area_lib.glsl `box_mean`.
    """
    box = np.asarray(box, dtype=np.float64)
    u0, v0, u1, v1 = np.moveaxis(box, -1, 0)
    inside = (u0 >= 0.0) & (u0 <= 1.0) & (u1 > u0) & (u1 <= u0 + 1.0) & (v0 >= 0.0) & (v1 > v0) & (v1 <= 1.0)
    if not np.all(inside):
        raise RangeError("A box to average a table over must have an area and lie within the table.")
    height, width = table.sums.shape[0] - 1, table.sums.shape[1] - 1
    columns, column_weights = _cut(u0 * width, u1 * width, 2 * width)
    rows, row_weights = _cut(v0 * height, v1 * height, height)
    sums = _sums_at(table.sums, rows[..., :, None], columns[..., None, :])
    blocks = np.diff(np.diff(sums, axis=-3), axis=-2)
    power = np.einsum("...j,...i,...jic->...c", row_weights, column_weights, blocks.astype(np.float64))
    bands = np.diff(-np.cos(np.pi * rows / height), axis=-1) * (2.0 * np.pi / width)
    solid_angle = np.einsum("...j,...j->...", row_weights, bands) * np.einsum(
        "...i,...i->...", column_weights, np.diff(columns, axis=-1)
    )
    mean: Array = power * table.unit / solid_angle[..., None]
    return mean


def _cut(low: Array, high: Array, last_edge: int) -> tuple[Indices, Array]:
    """An interval in three parts: its first texel, the texels that it holds whole, its last texel.

    Returns
    -------
    edges : ndarray of int, shape (..., 4)
    weights : ndarray, shape (..., 3)
        The part of each that lies within; 0 for the others where one texel holds it all.
    """
    first, last = np.floor(low), np.floor(high)
    several = last > first
    edges = np.stack([first, first + 1.0, last, last + 1.0], axis=-1).astype(np.intp)
    weights = np.stack(
        [np.minimum(high, first + 1.0) - low, several * 1.0, np.where(several, high - last, 0.0)], axis=-1
    )
    return np.minimum(edges, last_edge), weights


def _sums_at(sums: NDArray[np.int64], rows: Indices, columns: Indices) -> NDArray[np.int64]:
    """Sums below and left of texels' corners, columns counted on beyond the seam into a second turn."""
    width = sums.shape[1] - 1
    second = columns > width
    found: NDArray[np.int64] = sums[rows, columns - width * second] + second[..., None] * sums[rows, -1]
    return found
