"""Blender's working colour space, which a file's author may choose, and Rec. 709."""

import bpy as bpy  # Outside Blender, the module mathutils exists once bpy is imported.
import numpy as np
from mathutils import Color

from ..core.conventions import Array


def working_from_rec709(radiance: Array) -> Array:
    """Express scene-linear Rec. 709 radiance in the working space of the open file.

    Parameters
    ----------
    radiance : ndarray, shape (..., 3)

    Returns
    -------
    ndarray, shape (..., 3)
        Radiance for the nodes of shaders and the pixels of float images.

    Notes
    -----
    The same numbers, bit by bit, unless the file works in ACEScg or Rec. 2020.
    """
    return _converted(radiance, _working_matrix())


def rec709_from_working(radiance: Array) -> Array:
    """The inverse of `working_from_rec709`; shapes (..., 3)."""
    return _converted(radiance, np.linalg.inv(_working_matrix()))


def works_in_rec709() -> bool:
    """Whether the open file's working space is Rec. 709."""
    return bool(np.array_equal(_working_matrix(), np.eye(3)))


def _working_matrix() -> Array:
    """Columns: the Rec. 709 primaries in the working space."""
    return np.stack([Color(axis).from_rec709_linear_to_scene_linear() for axis in np.eye(3)], axis=1)


def _converted(radiance: Array, matrix: Array) -> Array:
    if np.array_equal(matrix, np.eye(3)):
        return radiance
    converted: Array = (radiance @ matrix.T).astype(radiance.dtype)
    return converted
