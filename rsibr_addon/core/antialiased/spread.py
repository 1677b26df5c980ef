"""How far a pixel's normals spread, and the roughness that this adds.

A pixel whose normals differ shows a surface that is rougher than its material. The spread of normals is half
the mean square of their angles from the mean, which is 1 less the mean's length where it is small.
"""

import numpy as np

from ..conventions import Array, ArrayLike
from ..geometry.directions import dot

WIDENING = 1.5
"""Square of alpha that a spread adds.

Facets whose angles spread so have 2 [Toksvig2005]; GGX has long tails, and its highlights are nearest to the
means over pixels with three quarters of that."""


def pixel_spread(across: ArrayLike, up: ArrayLike) -> Array:
    """Spread of the normals of pixels over which they change evenly.

    Parameters
    ----------
    across, up : array_like, shape (..., 3)
        Change of the unit normal from a pixel to the next one on its right, and to the next above.

    Returns
    -------
    ndarray, shape (...)

    Notes
    -----
    The mean square of places in a pixel along an axis is 1/12. GLSL twin: gpu_shaders/lib/spread_lib.glsl
    `pixel_spread`.
    """
    across, up = np.asarray(across), np.asarray(up)
    spread: Array = (dot(across, across) + dot(up, up)) / 24.0
    return spread


def mean_spread(mean: ArrayLike, rounding: float = 0.0) -> Array:
    """Spread of unit normals, of which the mean is known: texels of a normal map's mips.

    Parameters
    ----------
    mean : array_like, shape (..., 3)
    rounding : float
        Error of the mean's length: as much less is taken for no spread.

    Returns
    -------
    ndarray, shape (...)

    Notes
    -----
    [Toksvig2005]. GLSL twin: gpu_shaders/lib/spread_lib.glsl `mean_spread`.
    """
    length = np.maximum(np.linalg.norm(mean, axis=-1), 1e-3)
    spread: Array = np.maximum(1.0 - rounding - length, 0.0) / length
    return spread


def widened_roughness(roughness: ArrayLike, spread: ArrayLike) -> Array:
    """Roughness of a pixel whose normals spread.

    Parameters
    ----------
    roughness : array_like, shape (...)
        Square root of alpha.
    spread : array_like, shape (...)

    Returns
    -------
    ndarray, shape (...)
        1 at most.

    Notes
    -----
    GLSL twin: gpu_shaders/lib/spread_lib.glsl `widened_roughness`.
    """
    widened: Array = np.minimum(np.asarray(roughness) ** 4 + WIDENING * np.asarray(spread), 1.0) ** 0.25
    return widened
