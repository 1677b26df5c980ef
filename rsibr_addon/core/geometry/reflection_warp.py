"""The reflection-space warp between radiance sphere maps, and its confidence.

[Cabral1999] sections 3.2 and 3.3. A point of a map has a central reflection direction: the normal
for diffuse radiance, the mirrored view for glossy. A warp takes the point of one view's map to the
point of another view's map that has the same central direction:
p_s = g_s^-1 . T_s^-1 . T_d . g_d (p_d). Here g_d and T_d are a normal and a view direction in world
coordinates, so that the same functions serve a destination map and a fragment of a mesh.
"""

from enum import StrEnum

import numpy as np

from ..conventions import Array, ArrayLike
from ..maps.sphere_map import uv_from_direction, uv_from_normal
from .directions import dot, reflect


class Warp(StrEnum):
    """The direction that a warp keeps: g_normal or g_mirror of [Cabral1999] section 3.3."""

    NORMAL = "normal"
    MIRROR = "mirror"


TRUSTED_COSINE = 0.6
"""Cosine between a source's normal and its view above which the source is trusted in full."""

LEAST_CONFIDENCE = 1e-3
"""Confidence at the singularity itself, so that a single source still counts."""


def source_uv(warp: Warp, normal: ArrayLike, view_dir: ArrayLike, source_frame: ArrayLike) -> Array:
    """Place in a source map that shows a surface point's central direction.

    Parameters
    ----------
    warp : Warp
    normal, view_dir : array_like, shape (..., 3)
        The surface point's unit normal and unit direction to the eye, in world coordinates.
    source_frame : array_like, shape (..., 3, 3)
        Camera axes of the source map as columns, as `directions.camera_frame` makes them.

    Returns
    -------
    ndarray, shape (..., 2), float64
        (s, t) in the source's disk; on its rim when the source cannot see the direction.

    Notes
    -----
    GLSL twin: gpu_shaders/lib/reflection_warp_lib.glsl `source_uv`, 1e-5 where the source's
    confidence is above 0.1.
    """
    central = np.asarray(normal) if warp is Warp.NORMAL else reflect(view_dir, normal)
    in_camera = np.einsum("...ji,...j->...i", np.asarray(source_frame), central)
    return uv_from_normal(in_camera) if warp is Warp.NORMAL else uv_from_direction(in_camera)


def source_cosine(warp: Warp, normal: ArrayLike, view_dir: ArrayLike, source_view_dir: ArrayLike) -> Array:
    """Cosine between normal and view, where a source map shows a surface point's central direction.

    Parameters
    ----------
    warp : Warp
    normal, view_dir, source_view_dir : array_like, shape (..., 3)
        Unit vectors in world coordinates.

    Returns
    -------
    ndarray, shape (...,), float64
        In [-1, 1]; negative where the normal faces away from the source, 0 at the singularity of
        the mirror warp.

    Notes
    -----
    GLSL twin: gpu_shaders/lib/reflection_warp_lib.glsl `source_cosine`, 1e-6.
    """
    normal, source = np.asarray(normal), np.asarray(source_view_dir)
    if warp is Warp.NORMAL:
        return dot(normal, source)
    # The source's normal is the half vector of its view and the reflected direction.
    half: Array = 0.5 * np.linalg.norm(reflect(view_dir, normal) + source, axis=-1)
    return half


def confidence(cosine: ArrayLike) -> Array:
    """Confidence in a source map's radiance that was seen at a cosine.

    Parameters
    ----------
    cosine : array_like, shape (...,)
        As `source_cosine` tells.

    Returns
    -------
    ndarray, shape (...,), float64
        In [LEAST_CONFIDENCE, 1].

    Notes
    -----
    [Cabral1999] section 3.3 fades a source near its singularity, where the warp leads to the rim of the
    source's map, by the distance in the destination map. This takes the cosine at which the source saw the
    point. It is zero at the same place, but it measures the pinching itself, is the same for both warps and
    for a fragment without a destination map, and comes closer to Cycles (docs/accuracy.md). GLSL twin:
    gpu_shaders/lib/reflection_warp_lib.glsl `confidence`, 2e-6.
    """
    trusted: Array = np.clip(np.asarray(cosine) / TRUSTED_COSINE, LEAST_CONFIDENCE, 1.0)
    return trusted
