"""Both sides of a surface: normals that point to the eye's side, and that mirror nothing from within.

A surface has an outside, which the winding of its facets tells. The eye may see its inside: an open shell, a
leaf, a flat piece of cloth. And normals that are interpolated over a facet lean away from the facet's own: by
some of them an eye at a flat angle would see a mirror image of the object's inside.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..conventions import Array, ArrayLike
from .directions import dot, reflect

LEAST_RISE = 0.01
"""Sine of the angle above a facet below which its mirror directions are raised."""

LEAST_SHARE = 0.9
"""The same over the sine of the eye's own angle, where that is smaller."""


ROUNDING = 1e-9
"""Cosine of an angle that is no more than a right one: at outlines, where rounding would decide the side."""


@dataclass(frozen=True, eq=False)
class Seen:
    """What an eye sees of surface points.

    Attributes
    ----------
    normal : ndarray, shape (..., 3), float64
        Unit shading normals on the eye's side, by which diffuse light is looked up. At the outline they may
        lean away from the eye.
    mirror_normal : ndarray, shape (..., 3), float64
        The same, tilted so far that mirror directions rise above the facet: for all that depends on the
        mirror direction, and on the angle of the view.
    outside : ndarray of bool, shape (...)
        Whether the outside is seen.
    """

    normal: Array
    mirror_normal: Array
    outside: NDArray[np.bool]


def seen_surface(normal: ArrayLike, view_dir: ArrayLike, facet: ArrayLike | None = None) -> Seen:
    """The side of a surface that an eye sees, as Cycles has it.

    Parameters
    ----------
    normal : array_like, shape (..., 3)
        Unit shading normals, of the outside.
    view_dir : array_like, shape (..., 3)
        Unit vectors to the eye.
    facet : array_like, shape (..., 3), optional
        Unit normals of the facets, of the outside; those of a surface without facets are `normal`.

    Notes
    -----
    The facet decides which side is seen, and not the shading normal. GLSL twin:
    gpu_shaders/lib/sides_lib.glsl `seen_surface`, which has the facet from a pixel's neighbours.
    """
    facet = normal if facet is None else facet
    normal, view_dir, facet = np.broadcast_arrays(
        *(np.asarray(each, dtype=np.float64) for each in (normal, view_dir, facet))
    )
    outside: NDArray[np.bool] = np.asarray(dot(facet, view_dir) >= -ROUNDING)
    sign = np.where(outside, 1.0, -1.0)[..., None]
    return Seen(sign * normal, tilted_normal(sign * normal, view_dir, sign * facet), outside)


def tilted_normal(normal: ArrayLike, view_dir: ArrayLike, facet: ArrayLike) -> Array:
    """Normals by which an eye sees nothing mirrored from below the facet.

    Parameters
    ----------
    normal, view_dir : array_like, shape (..., 3)
        Unit vectors.
    facet : array_like, shape (..., 3)
        Unit normals of the facets, on the eye's side.

    Returns
    -------
    ndarray, shape (..., 3), float64
        `normal` where its mirror direction rises far enough above the facet: a hundredth, or nine tenths of
        what the eye does. Elsewhere the unit normal between `normal` and `facet` whose mirror direction does.

    Notes
    -----
    In the plane of normal and facet, the view's part is mirrored to one of the same length, whose rise is the
    wanted one: that gives its direction, and the normal is halfway. This is what Cycles' "Bump Map
    Correction" does. GLSL twin: gpu_shaders/lib/sides_lib.glsl `tilted_normal`, 2e-6 over the sine between
    normal and facet and over the rise of the view, where rounding does not decide whether to tilt.
    """
    normal, view_dir, facet = np.broadcast_arrays(
        *(np.asarray(each, dtype=np.float64) for each in (normal, view_dir, facet))
    )
    up = dot(view_dir, facet)
    least = np.minimum(LEAST_SHARE * up, LEAST_RISE)
    low = dot(reflect(view_dir, normal), facet) < least
    along = normal - dot(normal, facet)[..., None] * facet
    along = along / np.maximum(np.linalg.norm(along, axis=-1, keepdims=True), 1e-9)
    aside = dot(view_dir, along)
    mirrored = np.sqrt(np.maximum(aside**2 + up**2 - least**2, 0.0))
    tilted = (aside + mirrored)[..., None] * along + (up + least)[..., None] * facet
    length = np.linalg.norm(tilted, axis=-1, keepdims=True)
    # An eye in the facet's plane, on the side that the normal leans away from, sees the facet itself
    tilted = np.where(length > 1e-9, tilted / np.maximum(length, 1e-9), facet)
    chosen: Array = np.where(low[..., None], tilted, normal)
    return chosen
