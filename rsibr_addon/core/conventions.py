"""Axes, uv origin, row order: the one place where they are defined.

World
    Blender's axes: right-handed, Z up. Directions are unit vectors that point away from the
    surface, in arrays of shape (..., 3).
Radiance
    Scene-linear Rec. 709, no exposure baked in. Irradiance is not divided by pi.
Maps
    Arrays of shape (height, width, channels). **Row 0 is the bottom row**: uv = (0, 0) is the
    bottom-left corner of the map, texel (row j, column i) has its centre at
    ((i + 0.5) / width, (j + 0.5) / height). Blender's image pixels and OpenGL's textures agree;
    files that store the top row first are flipped on reading and writing, and nowhere else.
Texels
    A texel has constant radiance over its solid angle.
Angles
    Radians in code, degrees in interfaces.
"""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.floating[Any]]
"""An array of floating-point numbers of any shape; docstrings say which."""

Indices = NDArray[np.integer[Any]]
"""An array of integers; docstrings say what they index."""

__all__ = ["WORLD_AXES", "Array", "ArrayLike", "Indices", "texel_centres"]

WORLD_AXES = "right-handed, Z up, as Blender's world; row 0 of a map is its bottom row"


def texel_centres(width: int, height: int) -> Array:
    """The uv of every texel centre of a map.

    Parameters
    ----------
    width, height : int
        Size of the map in texels.

    Returns
    -------
    ndarray, shape (height, width, 2), float64
        u in [..., 0] and v in [..., 1], each in (0, 1).
    """
    u = (np.arange(width) + 0.5) / width
    v = (np.arange(height) + 0.5) / height
    return np.stack(np.broadcast_arrays(u[None, :], v[:, None]), axis=-1)
