"""The reference of every shading mode, per pixel.

Each mode is one function here and its twin in `gpu_shaders`. Radiance views [Cabral1999] come in
three modes. `views_fragment` needs nothing but a normal and a view direction. The others make the
sphere map of one view first, texel by texel (`destination_by_texel`) or over a tessellated disk as
the paper does (`destination_by_mesh`), and `destination_lookup` shades from it.
"""

from dataclasses import dataclass

import numpy as np

from .conventions import Array, ArrayLike, Indices, texel_centres
from .directions import camera_frame, reflect
from .disk_mesh import MARGIN, disk_mesh, interpolate
from .geodesic import barycentric_weights, find_triangle
from .maps import sphere_map
from .radiance_views import RadianceViews
from .reflection_warp import Warp, confidence, source_uv
from .resample import bilinear


@dataclass(frozen=True)
class Destination:
    """The warped and blended sphere map of one view direction.

    Attributes
    ----------
    frame : ndarray, shape (3, 3)
        Camera axes of the view as columns: T_d of [Cabral1999].
    by_normal, by_mirror : ndarray, shape (size, size, 3), float64
        Radiance to be looked up by the normal (diffuse; 0 for a single warp) and by the mirrored
        view direction (glossy, or the whole).
    """

    frame: Array
    by_normal: Array
    by_mirror: Array


def views_fragment(views: RadianceViews, normal: ArrayLike, view_dir: ArrayLike, split: bool) -> Array:
    """Radiance of surface points, each blended from the three views around its own view direction.

    Parameters
    ----------
    views : RadianceViews
    normal, view_dir : array_like, shape (..., 3)
        Unit vectors in world coordinates.
    split : bool
        Warp diffuse radiance by the normal and glossy by the mirror direction; else the whole by
        the mirror direction.

    Returns
    -------
    ndarray, shape (..., 3), float64
        Radiance.

    Notes
    -----
    [Cabral1999] sections 3.2-3.4 for every fragment: the view direction of each is its own, so
    that perspective adds no error. GLSL twin: gpu_shaders/views_fragment_frag.glsl.
    """
    normal, view_dir = np.broadcast_arrays(np.asarray(normal, np.float64), np.asarray(view_dir, np.float64))
    if split:
        diffuse = _warp_and_blend(views, views.diffuse, Warp.NORMAL, normal, view_dir)
        return diffuse + _warp_and_blend(views, views.glossy, Warp.MIRROR, normal, view_dir)
    return _warp_and_blend(views, views.combined, Warp.MIRROR, normal, view_dir)


def destination_by_texel(views: RadianceViews, view_dir: ArrayLike, size: int, split: bool) -> Destination:
    """The destination map of one view, warped per texel: the future work of [Cabral1999] section 6.

    Parameters
    ----------
    views : RadianceViews
    view_dir : array_like, shape (3,)
        Unit vector from the object to the eye.
    size : int
        Width and height of the destination map in texels.
    split : bool
        As in `views_fragment`.

    Returns
    -------
    Destination

    Notes
    -----
    GLSL twin: gpu_shaders/views_texel_frag.glsl.
    """
    frame = camera_frame(view_dir)
    normal = sphere_map.normal_from_uv(texel_centres(size, size)) @ frame.T
    direction = np.broadcast_to(frame[:, 2], normal.shape)
    if not split:
        whole = _warp_and_blend(views, views.combined, Warp.MIRROR, normal, direction)
        return Destination(frame, np.zeros_like(whole), whole)
    return Destination(
        frame,
        _warp_and_blend(views, views.diffuse, Warp.NORMAL, normal, direction),
        _warp_and_blend(views, views.glossy, Warp.MIRROR, normal, direction),
    )


def destination_by_mesh(views: RadianceViews, view_dir: ArrayLike, size: int, split: bool) -> Destination:
    """The destination map of one view, warped at the vertices of a tessellated disk: the paper's way.

    Parameters and result are those of `destination_by_texel`.

    Notes
    -----
    [Cabral1999] section 3.3 and the loop of section 4, its accumulation buffer replaced by one
    weighted sum. GLSL twin: gpu_shaders/views_disk_vert.glsl and views_disk_frag.glsl.
    """
    frame = camera_frame(view_dir)
    sources = find_triangle(views.sphere, frame[:, 2])
    weights = barycentric_weights(frame[:, 2], views.sphere.vertices[sources])
    vertex_normal = sphere_map.normal_from_uv(0.5 * disk_mesh().positions + 0.5) @ frame.T
    points = 2.0 * texel_centres(size, size) - 1.0
    # The corners of the map, outside the mesh's margin, are never looked up.
    points /= np.maximum(np.linalg.norm(points, axis=-1, keepdims=True) / (0.99 * MARGIN), 1.0)

    def blend(maps: Array, warp: Warp) -> Array:
        at_vertices = [
            np.concatenate([uv, trust[:, None]], axis=-1)
            for uv, trust in _seen_by(views, warp, vertex_normal, frame[:, 2], sources)
        ]
        seen = [interpolate(points, values) for values in at_vertices]
        shares = _shares(weights, np.stack([values[..., 2] for values in seen], axis=-1))
        return _weighted_sum(maps, sources, [values[..., :2] for values in seen], shares)

    if not split:
        whole = blend(views.combined, Warp.MIRROR)
        return Destination(frame, np.zeros_like(whole), whole)
    return Destination(frame, blend(views.diffuse, Warp.NORMAL), blend(views.glossy, Warp.MIRROR))


def destination_lookup(destination: Destination, normal: ArrayLike, view_dir: ArrayLike) -> Array:
    """Radiance of surface points, from the sphere map of one view.

    Parameters
    ----------
    destination : Destination
    normal, view_dir : array_like, shape (..., 3)
        Unit vectors in world coordinates.

    Returns
    -------
    ndarray, shape (..., 3), float64
        Radiance; exact only where the view direction is the map's own, so not in perspective.

    Notes
    -----
    Glossy radiance is looked up by the mirrored view direction, as sphere-mapping hardware does
    ([Cabral1999] section 2); in an orthographic view that is the point of the normal itself.
    GLSL twin: gpu_shaders/views_destination_frag.glsl.
    """
    normal_in_camera = np.asarray(normal) @ destination.frame
    mirror_in_camera = reflect(view_dir, normal) @ destination.frame
    by_normal = bilinear(destination.by_normal, sphere_map.uv_from_normal(normal_in_camera), sphere_map.wrap)
    by_mirror = bilinear(
        destination.by_mirror, sphere_map.uv_from_direction(mirror_in_camera), sphere_map.wrap
    )
    return by_normal + by_mirror


def _warp_and_blend(views: RadianceViews, maps: Array, warp: Warp, normal: Array, view_dir: Array) -> Array:
    """Look `maps` up in the three views around each view direction, shape (..., 3)."""
    sources = find_triangle(views.sphere, view_dir)
    weights = barycentric_weights(view_dir, views.sphere.vertices[sources])
    seen = _seen_by(views, warp, normal, view_dir, sources)
    shares = _shares(weights, np.stack([trust for _, trust in seen], axis=-1))
    return _weighted_sum(maps, sources, [uv for uv, _ in seen], shares)


def _seen_by(
    views: RadianceViews, warp: Warp, normal: Array, view_dir: Array, sources: Indices
) -> list[tuple[Array, Array]]:
    """Where each of the three sources shows the surface points, and the confidence in it."""
    return [
        (
            source_uv(warp, normal, view_dir, views.frames[sources[..., i]]),
            confidence(warp, normal, view_dir, views.sphere.vertices[sources[..., i]]),
        )
        for i in range(3)
    ]


def _shares(weights: Array, trust: Array) -> Array:
    """Weights times confidences, to sum 1: [Cabral1999] section 4 divides by what it accumulated."""
    product = weights * trust
    shares: Array = product / product.sum(axis=-1, keepdims=True)
    return shares


def _weighted_sum(maps: Array, sources: Indices, uvs: list[Array], shares: Array) -> Array:
    """Sum of the three sources' radiance, each looked up at its own place."""
    return np.sum(
        [
            shares[..., i, None] * bilinear(maps, uvs[i], sphere_map.wrap, layer=sources[..., i])
            for i in range(3)
        ],
        axis=0,
    )
