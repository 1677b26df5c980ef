"""The three ways of [Miller1984] section 8 as previews have them, for maps that are looked up between texels.

`recursive` and `quadrilateral` are the paper's own, exact and slow.
"""

from collections.abc import Callable
from enum import StrEnum

import numpy as np

from ..conventions import Array, ArrayLike
from ..maps import equirect
from ..resample import bilinear
from .footprint import footprint_box, footprint_parts, footprint_sides
from .sampling import sample_counts, samples
from .strips import strip_means
from .summed_area import SummedAreaTable, box_mean, summed_area_table

SMALL = 1.001
"""Width and height [texels] of the smallest boxes that `footprint_box` makes, for smaller footprints."""

MOST_SUBDIVIDED = 16
"""Most lookups along each side of a footprint that is subdivided."""


class Averaging(StrEnum):
    """How a pixel's footprint is averaged.

    SUBDIVIDE looks a map up once for each texel, QUADRILATERAL integrates the footprint row by row, SUMMED
    takes rectangles that hold its parts.
    """

    SUBDIVIDE = "subdivide"
    QUADRILATERAL = "quadrilateral"
    SUMMED = "summed"


def footprint_mean(image: Array, direction: ArrayLike, corners: ArrayLike, averaging: Averaging) -> Array:
    """Mean radiance over footprints on a map.

    Parameters
    ----------
    image : ndarray, shape (height, 2 * height, channels)
        An equirectangular map.
    direction : array_like, shape (..., 3)
        Unit directions in the footprints' middles.
    corners : array_like, shape (..., 4, 3)
        See `footprint.footprint_box`.
    averaging : Averaging

    Returns
    -------
    ndarray, shape (..., channels), float64
        Of footprints no larger than a texel, radiance interpolated in the middle.

    Raises
    ------
    RangeError
        See `summed_area_table`.

    Notes
    -----
    SUBDIVIDE: lookups lie a texel apart. What takes more than `MOST_SUBDIVIDED` along a side is SUMMED, so
    that nothing is missed. GLSL twin: gpu_shaders/lib/averaging_lib.glsl `footprint_mean`.
    """
    direction, corners = np.asarray(direction, np.float64), np.asarray(corners, np.float64)
    height, width = image.shape[:2]
    mean = bilinear(image, equirect.uv_from_direction(direction), equirect.wrap)
    if averaging is Averaging.SUBDIVIDE:
        across, up = footprint_sides(corners)
        counts = sample_counts(across, up, _texel_angle(direction, height), MOST_SUBDIVIDED + 1)
        boxed = np.any(counts > MOST_SUBDIVIDED, axis=-1)
        several = ~boxed & np.any(counts > 1, axis=-1)
        mean[several] = 0.0
        counts[~several] = 0
        for chosen, towards, weight in samples(direction, across, up, counts):
            mean[chosen] += weight * bilinear(image, equirect.uv_from_direction(towards), equirect.wrap)
        means: Callable[[SummedAreaTable, Array], Array] = summed_means
    else:
        box = footprint_box(corners, width, height)
        boxed = ~np.all((box[..., 2:] - box[..., :2]) * (width, height) < SMALL, axis=-1)
        means = strip_means if averaging is Averaging.QUADRILATERAL else summed_means
    if np.any(boxed):
        mean[boxed] = means(summed_area_table(image), corners[boxed])
    return mean


def summed_means(table: SummedAreaTable, corners: Array) -> Array:
    """Means over the boxes that hold parts of footprints: see `footprint_parts`.

    Parameters
    ----------
    table : SummedAreaTable
    corners : ndarray, shape (n, 4, 3)

    Returns
    -------
    ndarray, shape (n, channels), float64

    Notes
    -----
    [Miller1984] section 8.3. GLSL twin: gpu_shaders/lib/averaging_lib.glsl `summed_mean`.
    """
    height, width = table.sums.shape[0] - 1, table.sums.shape[1] - 1
    mean = np.zeros((len(corners), table.sums.shape[-1]))
    for chosen, part, weight in footprint_parts(corners, height):
        mean[chosen] += weight * box_mean(table, footprint_box(part, width, height))
    return mean


def _texel_angle(direction: Array, height: int) -> Array:
    """Square root of a texel's solid angle, at the poles that of half a row from them."""
    sine = np.maximum(np.hypot(direction[..., 0], direction[..., 1]), 0.5 * np.pi / height)
    angle: Array = np.pi / height * np.sqrt(sine)
    return angle
