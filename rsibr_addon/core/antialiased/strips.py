"""The quadrilateral of a pixel's corner directions, [Miller1984] section 8.2, as rows of a summed table."""

import numpy as np

from ..conventions import Array
from ..maps import equirect
from .footprint import footprint_box
from .summed_area import SummedAreaTable, box_mean

MOST_STRIPS = 32
"""Most strips of a quadrilateral; where it has more rows, a strip has several."""

LEAST_WIDTH = 1e-3
"""Least width [texels] by which a strip's mean counts, so that one without any counts too."""

WHOLE = 1e-3
"""Part of a row that needs no strip of its own: boxes may have whole rows, but for rounding."""


def strip_means(table: SummedAreaTable, corners: Array) -> Array:
    """Means of a table over quadrilaterals, as strips along its rows.

    Parameters
    ----------
    table : SummedAreaTable
    corners : ndarray, shape (n, 4, 3)
        Directions of any positive length, in order around the pixel.

    Returns
    -------
    ndarray, shape (n, channels), float64

    Notes
    -----
    A strip reaches from the leftmost to the rightmost edge at its middle, which are straight in the table,
    and has at least a texel's width. Around a pole the quadrilateral is its box.
    `quadrilateral.quadrilateral_mean` is exact. GLSL twin: gpu_shaders/lib/averaging_lib.glsl `strip_mean`.
    """
    height, width = table.sums.shape[0] - 1, table.sums.shape[1] - 1
    whole = footprint_box(corners, width, height)
    x, y = _unrolled(corners) * np.array([width, height])[:, None, None]
    low, high = whole[:, 1] * height, whole[:, 3] * height
    around = whole[:, 2] - whole[:, 0] >= 1.0
    count = np.where(around, 1.0, np.clip(np.ceil(high - low - WHOLE), 1.0, MOST_STRIPS))
    total, weights = np.zeros((len(corners), table.sums.shape[-1])), np.zeros(len(corners))
    for strip in range(int(count.max(initial=0))):
        on = strip < count
        begin, end = (low + (high - low) * np.minimum(strip + k, count) / count for k in (0.0, 1.0))
        left, right = _span(x[on], y[on], 0.5 * (begin + end)[on])
        middle, half = 0.5 * (left + right), 0.5 * np.maximum(right - left, 1.0)
        box = np.stack(
            [(middle - half) / width, begin[on] / height, (middle + half) / width, end[on] / height], 1
        )
        box[:, ::2] -= np.floor(box[:, :1])
        box[around[on]] = whole[on & around]
        weight = np.maximum(right - left, LEAST_WIDTH) * np.sin(0.5 * np.pi / height * (begin + end)[on])
        total[on] += weight[:, None] * box_mean(table, box)
        weights[on] += weight
    mean: Array = total / weights[:, None]
    return mean


def _unrolled(corners: Array) -> Array:
    """U and v of corners, shape (2, n, 4); from each to the next the short way."""
    uv = equirect.uv_from_direction(corners)
    steps = np.diff(uv[..., 0], axis=-1)
    ahead = np.cumsum(steps - np.round(steps), axis=-1)
    u = uv[..., :1, 0] + np.concatenate([np.zeros_like(ahead[:, :1]), ahead], axis=-1)
    return np.stack([u, uv[..., 1]])


def _span(x: Array, y: Array, at: Array) -> tuple[Array, Array]:
    """Leftmost and rightmost point of polygons at a height; all of them where no edge crosses it."""
    to_x, to_y = np.roll(x, -1, axis=1), np.roll(y, -1, axis=1)
    crosses = (y <= at[:, None]) != (to_y <= at[:, None])
    rise = np.where(crosses, to_y - y, 1.0)
    crossing = x + (at[:, None] - y) / rise * (to_x - x)
    flat = ~np.any(crosses, axis=1)[:, None]
    left = np.min(np.where(crosses, crossing, np.where(flat, x, np.inf)), axis=1)
    right = np.max(np.where(crosses, crossing, np.where(flat, x, -np.inf)), axis=1)
    return left, right
