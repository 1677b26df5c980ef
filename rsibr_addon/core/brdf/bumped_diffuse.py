"""Diffuse reflection about a bumped normal: what the surface below hides of the light.

A normal map or a bump leans the normal away from the surface's own, and Lambert's cosine about it would see
light from below the surface. Cycles takes that away, and has the rest fall smoothly towards the horizon
[Estevez2019]. What is left of the cosine is taken to be another cosine: its axis is the mean direction, and
its share of the light of an even environment is the same.
"""

import numpy as np

from ..conventions import Array, ArrayLike
from ..geometry.directions import dot, normalize

_HIDDEN, _LEAST = 0.87, 0.3
"""Share of an even light that is hidden, over 1 - cos of how far the normal leans; and the least
that is left: within .006 of the integral up to 65 degrees."""

_BENT = 0.56, 0.14
"""a and b: the axis is the normal plus x (a + b x) of the surface's own, where x is the chord between both.
Up to 70 degrees it is within a degree of the mean direction."""


def shadowing(normal: ArrayLike, smooth_normal: ArrayLike, light_dir: ArrayLike) -> Array:
    """Factor of the light of a direction, as Cycles has it, shape (...,).

    Parameters
    ----------
    normal, smooth_normal, light_dir : array_like, shape (..., 3)
        Unit vectors: the bumped normal, the surface's own, and one to the light.
    """
    lean, rise = dot(np.asarray(normal), smooth_normal), dot(np.asarray(smooth_normal), light_dir)
    alpha_squared = np.minimum(0.125 * (1.0 / np.maximum(lean, 1e-6) ** 2 - 1.0), 1.0)
    tangent_squared = 1.0 / np.maximum(rise, 1e-6) ** 2 - 1.0
    factor: Array = np.where(rise > 0.0, 2.0 / (1.0 + np.sqrt(1.0 + alpha_squared * tangent_squared)), 0.0)
    return factor


def bumped_cosine(normal: ArrayLike, smooth_normal: ArrayLike) -> tuple[Array, Array]:
    """The cosine that is left of Lambert's about a bumped normal.

    Parameters
    ----------
    normal, smooth_normal : array_like, shape (..., 3)
        Unit vectors: the bumped normal, and the surface's own.

    Returns
    -------
    axis : ndarray, shape (..., 3)
        Unit vectors.
    share : ndarray, shape (...,)
        Up to 1, which it is where nothing is bumped.

    Notes
    -----
    GLSL twin: gpu_shaders/lib/bumped_diffuse_lib.glsl `bumped_cosine`.
    """
    normal, smooth_normal = np.asarray(normal, np.float64), np.asarray(smooth_normal, np.float64)
    fall = 1.0 - np.clip(dot(normal, smooth_normal), 0.0, 1.0)
    chord = np.sqrt(2.0 * fall)
    axis = normalize(normal + (chord * (_BENT[0] + _BENT[1] * chord))[..., None] * smooth_normal)
    return axis, np.maximum(1.0 - _HIDDEN * fall, _LEAST)
