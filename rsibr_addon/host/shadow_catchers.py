"""Shadow catchers: floors that show nothing but the shadows on them, and what casts these."""

import bpy
import numpy as np

from ..core.conventions import Array

FLATNESS = 1e-3
"""Distance of a vertex from a floor's plane, as a share of the floor's size, that still counts as flat."""


def floor_plane(evaluated: bpy.types.Object) -> Array | None:
    """The plane of a flat object.

    Parameters
    ----------
    evaluated : bpy.types.Object
        Has a mesh.

    Returns
    -------
    ndarray, shape (2, 3), or None
        A point and the normal, in the object's coordinates; None where it has no faces or is not flat.
    """
    mesh = evaluated.data
    if not mesh.polygons:
        return None
    places: Array = np.empty((len(mesh.vertices), 3), np.float32)
    mesh.vertices.foreach_get("co", places.ravel())
    normal, point = np.array(mesh.polygons[0].normal), places.mean(axis=0)
    size = np.ptp(places, axis=0).max()
    flat = np.abs((places - point) @ normal).max() <= FLATNESS * size
    return np.array([point, normal]) if flat else None


def corners(evaluated: bpy.types.Object) -> Array:
    """Corners of an object's bounds in its own coordinates, shape (8, 3)."""
    return np.array([corner[:] for corner in evaluated.bound_box])
