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


class Fading(StrEnum):
    """What fades a source towards its singularity, where the warp leads to the rim of its map.

    COSINE is the cosine between normal and view at which the source saw a point. DISTANCE is that of
    [Cabral1999] section 3.3, from the singularity in the destination map; only the mirror warp has one there.
    """

    COSINE = "cosine"
    DISTANCE = "distance"


TRUSTED_COSINE, TRUSTED_DISTANCE = 0.6, 1.0
"""Cosine between a source's normal and its view, and distance from its singularity in radii of the
destination map, above which the source is trusted in full."""

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


def singularity_distance(normal: ArrayLike, view_dir: ArrayLike, source_view_dir: ArrayLike) -> Array:
    """Distance in the map of a view from where a source's mirror warp is singular.

    Parameters
    ----------
    normal, view_dir, source_view_dir : array_like, shape (..., 3)
        Unit vectors in world coordinates. In the map of the source itself all of the rim is singular; the
        distance from its middle is told.

    Returns
    -------
    ndarray, shape (...,), float64
        In radii of the map, from 0 to 2.

    Notes
    -----
    [Cabral1999] section 3.3: the singularity's place is that of the reflection direction -source_view_dir,
    warped into the destination map. Maps are orthographic, so a distance in the map is one across the view.
    GLSL twin: gpu_shaders/lib/reflection_warp_lib.glsl `singularity_distance`, 1e-5.
    """
    view_dir = np.asarray(view_dir, dtype=np.float64)
    between = view_dir - np.asarray(source_view_dir)
    apart = np.asarray(normal) - between / np.maximum(np.linalg.norm(between, axis=-1, keepdims=True), 1e-6)
    distance: Array = np.linalg.norm(apart - dot(apart, view_dir)[..., None] * view_dir, axis=-1)
    return distance


def source_trust(
    fading: Fading, warp: Warp, normal: ArrayLike, view_dir: ArrayLike, source_view_dir: ArrayLike
) -> Array:
    """How far a surface point is from a source's singularity, over how far makes it trusted in full.

    Parameters
    ----------
    fading : Fading
    warp : Warp
    normal, view_dir, source_view_dir : array_like, shape (..., 3)
        Unit vectors in world coordinates.

    Returns
    -------
    ndarray, shape (...,), float64
        Negative where the normal faces away from the source.

    Notes
    -----
    Both ways are 0 at the same place. The cosine measures the pinching itself, is the same for both warps and
    for a fragment without a destination map, and comes closer to Cycles (docs/accuracy.md). GLSL twin:
    gpu_shaders/lib/reflection_warp_lib.glsl `source_trust`, 1e-5.
    """
    if fading is Fading.DISTANCE and warp is Warp.MIRROR:
        return singularity_distance(normal, view_dir, source_view_dir) / TRUSTED_DISTANCE
    return source_cosine(warp, normal, view_dir, source_view_dir) / TRUSTED_COSINE


def confidence(trust: ArrayLike) -> Array:
    """Confidence in a source map's radiance.

    Parameters
    ----------
    trust : array_like, shape (...,)
        As `source_trust` tells.

    Returns
    -------
    ndarray, shape (...,), float64
        In [LEAST_CONFIDENCE, 1].

    Notes
    -----
    GLSL twin: gpu_shaders/lib/reflection_warp_lib.glsl `confidence`, 2e-6.
    """
    trusted: Array = np.clip(np.asarray(trust), LEAST_CONFIDENCE, 1.0)
    return trusted
