"""Shading from radiance views [Cabral1999], in three modes.

`views_fragment` needs only a normal and a view direction. The other modes first make the sphere map of one
view, texel by texel (`destination_by_texel`) or over a tessellated disk as the paper does
(`destination_by_mesh`), and `destination_lookup` shades from it.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from ...antialiased.footprint import footprint_or_point, footprint_sides
from ...antialiased.sampling import sample_counts, samples
from ...conventions import Array, ArrayLike, Indices, texel_centres
from ...geometry.directions import camera_frame, dot, mirror_normal, reflect
from ...geometry.disk_mesh import MARGIN, disk_mesh, interpolate
from ...geometry.geodesic import barycentric_weights, find_triangle
from ...geometry.reflection_warp import Fading, Warp, confidence, source_cosine, source_trust, source_uv
from ...geometry.sides import Seen, seen_surface
from ...maps import sphere_map
from ...options import Choice, Options, option
from ...resample import bilinear
from ..look_options import antialiased_option
from .views import RadianceViews
from .warping import WarpChoice, Warping, albedo_at, albedo_table, carried


class Mode(StrEnum):
    """Ways to bring radiance views to the view of a frame."""

    PAPER = "paper"
    TEXEL = "texel"
    FRAGMENT = "fragment"


@dataclass(frozen=True)
class ViewsLook(Options):
    """How radiance views are shaded."""

    mode: Mode = option(
        Mode.FRAGMENT,
        label="Mode",
        help="Where views are warped and blended",
        choices={
            Mode.FRAGMENT: Choice("Fragment", "for each fragment with its own view: right in perspective"),
            Mode.TEXEL: Choice("Texel", "once a frame, for each texel of a sphere map"),
            Mode.PAPER: Choice("Paper", "once a frame, on a tessellated disk, as in the paper of 1999"),
        },
    )
    warping: WarpChoice = option(
        WarpChoice.AUTO,
        label="Warp",
        help="How the views' light is warped",
        choices={
            WarpChoice.AUTO: Choice(
                "Automatic", "as predicts captured views best from their neighbours, faded by the cosine"
            ),
            WarpChoice.ALBEDO: Choice("Albedo", "as by parts, over the material's directional albedo"),
            WarpChoice.SPLIT: Choice(
                "By Parts", "diffuse light by the normal, glossy by the mirror direction"
            ),
            WarpChoice.SINGLE: Choice("Single", "all light by the mirror direction, as in the paper of 1999"),
        },
        flag="--warp",
    )
    fading: Fading = option(
        Fading.COSINE,
        label="Fading",
        help="What tells how far a view is trusted near where its map is pinched",
        choices={
            Fading.COSINE: Choice("Cosine", "the one at which the view saw a point: closer to Cycles"),
            Fading.DISTANCE: Choice("Distance", "that from the pinched place, as in the paper of 1999"),
        },
        advanced=True,
    )
    antialiased: bool = antialiased_option("glossy light")


@dataclass(frozen=True)
class Destination:
    """The warped and blended sphere map of one view direction.

    Attributes
    ----------
    frame : ndarray, shape (3, 3)
        Camera axes of the view as columns: T_d of [Cabral1999].
    by_normal, by_mirror : ndarray, shape (size, size, 3), float64
        Radiance to be looked up by the normal (diffuse; 0 for a single warp) and by the mirrored
        view direction (glossy, or the whole); for `Warping.ALBEDO`, over albedo.
    albedo : ndarray, shape (2, M, 3)
        Factors of the radiance by normal, and by mirror, as in `RadianceViews.albedo`.
    """

    frame: Array
    by_normal: Array
    by_mirror: Array
    albedo: Array


def views_fragment(
    views: RadianceViews,
    normal: ArrayLike,
    view_dir: ArrayLike,
    warping: Warping,
    mirror_footprint: ArrayLike | None = None,
    facet: ArrayLike | None = None,
    fading: Fading = Fading.COSINE,
) -> Array:
    """Radiance of surface points, each blended from the three views around its own view direction.

    Parameters and result are those of every kind's shading, see `core.kinds`, with the warping and the fading
    of the look; the footprint is None for looks that are not antialiased.

    Notes
    -----
    [Cabral1999] sections 3.2-3.4 for every fragment: each has its own view direction, so that perspective
    adds no error. Within a pixel the mirror direction changes, and radiance by it takes up to `sampling.MOST`
    lookups along each side, a texel apart. GLSL twin: gpu_shaders/views_fragment_frag.glsl.
    """
    normal, view_dir = np.broadcast_arrays(np.asarray(normal, np.float64), np.asarray(view_dir, np.float64))
    seen = seen_surface(normal, view_dir, facet)
    by_normal, _ = _warp_and_blend(views, seen.normal, view_dir, warping, fading)
    _, by_mirror = _warp_and_blend(views, seen.mirror_normal, view_dir, warping, fading)
    if mirror_footprint is not None:
        by_mirror = np.zeros(normal.shape)
        spread = _spread(mirror_footprint, reflect(view_dir, seen.mirror_normal), views.size)
        for chosen, direction, weight in spread:
            own_view = view_dir[chosen]
            shown = _warp_and_blend(views, mirror_normal(own_view, direction), own_view, warping, fading)[1]
            by_mirror[chosen] += weight * shown
    return _coloured(albedo_table(views.albedo, warping), seen, view_dir, by_normal, by_mirror)


def source_shares(
    views: RadianceViews, view_dir: ArrayLike, size: int, warping: Warping
) -> tuple[Indices, Array]:
    """The sphere map of one view, source by source: Figure 4 of [Cabral1999].

    Parameters
    ----------
    views : RadianceViews
    view_dir : array_like, shape (3,)
        Unit vector from the object to the eye.
    size : int
        Width and height of the map in texels.
    warping : Warping

    Returns
    -------
    sources : ndarray of int, shape (3,)
        Numbers of the views that are blended.
    shares : ndarray, shape (3, size, size, 3)
        Each of them warped and weighted; their sum is what `views_fragment` shows.
    """
    frame = camera_frame(view_dir)
    normal = sphere_map.normal_from_uv(texel_centres(size, size)) @ frame.T
    sources = find_triangle(views.sphere, frame[:, 2])
    weights = barycentric_weights(frame[:, 2], views.sphere.vertices[sources])
    table = albedo_table(views.albedo, warping)
    shares = np.zeros((*normal.shape[:-1], 3, 3))
    for warp, maps in carried(views.diffuse, views.glossy, warping).items():
        seen = _seen(views, warp, normal, frame[:, 2], sources, Fading.COSINE)
        own = albedo_at(table, warp, dot(normal, frame[:, 2]))
        shares += own[..., None, :] * _weighted(maps, warp, table, sources, seen, weights)
    return sources, np.moveaxis(shares, -2, 0)


def destination_by_texel(
    views: RadianceViews, view_dir: ArrayLike, size: int, warping: Warping, fading: Fading = Fading.COSINE
) -> Destination:
    """The destination map of one view, warped per texel: the future work of [Cabral1999] section 6.

    Parameters are those of `source_shares`, and a fading.

    Notes
    -----
    GLSL twin: gpu_shaders/views_texel_frag.glsl.
    """
    frame = camera_frame(view_dir)
    normal = sphere_map.normal_from_uv(texel_centres(size, size)) @ frame.T
    direction = np.broadcast_to(frame[:, 2], normal.shape)
    blended = _warp_and_blend(views, normal, direction, warping, fading)
    return Destination(frame, *blended, albedo_table(views.albedo, warping))


def destination_by_mesh(
    views: RadianceViews, view_dir: ArrayLike, size: int, warping: Warping, fading: Fading = Fading.COSINE
) -> Destination:
    """The destination map of one view, warped at the vertices of a tessellated disk: the paper's way.

    Parameters are those of `source_shares`, and a fading.

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
    table = albedo_table(views.albedo, warping)

    def blend(maps: Array, warp: Warp) -> Array:
        at_vertices = _seen(views, warp, vertex_normal, frame[:, 2], sources, fading)
        seen = np.stack([interpolate(points, at_vertices[..., i, :]) for i in range(3)], axis=-2)
        return _blend(maps, warp, table, sources, seen, weights)

    return Destination(frame, *_by_both_warps(views, warping, blend), table)


def destination_lookup(
    destination: Destination,
    normal: ArrayLike,
    view_dir: ArrayLike,
    mirror_footprint: ArrayLike | None = None,
    facet: ArrayLike | None = None,
) -> Array:
    """Radiance of surface points, from the sphere map of one view; parameters as those of `views_fragment`.

    Exact only where the view direction is the map's own, so not in perspective.

    Notes
    -----
    Glossy radiance is looked up by the mirrored view direction, as sphere-mapping hardware does
    ([Cabral1999] section 2); in an orthographic view that is the point of the normal itself.
    GLSL twin: gpu_shaders/views_destination_frag.glsl.
    """
    seen = seen_surface(normal, view_dir, facet)
    normal_uv = sphere_map.uv_from_normal(seen.normal @ destination.frame)
    mirror_dir, by_mirror = reflect(view_dir, seen.mirror_normal), destination.by_mirror
    glossy = np.zeros(mirror_dir.shape)
    for chosen, direction, weight in _spread(mirror_footprint, mirror_dir, len(by_mirror)):
        mirror_uv = sphere_map.uv_from_direction(direction @ destination.frame)
        glossy[chosen] += weight * bilinear(by_mirror, mirror_uv, sphere_map.wrap)
    diffuse = bilinear(destination.by_normal, normal_uv, sphere_map.wrap)
    return _coloured(destination.albedo, seen, np.asarray(view_dir), diffuse, glossy)


def _spread(
    mirror_footprint: ArrayLike | None, mirror_dir: Array, size: int
) -> Iterator[tuple[NDArray[np.bool], Array, Array]]:
    """Directions a texel of sphere maps apart, as `sampling.samples` yields them."""
    across, up = footprint_sides(footprint_or_point(mirror_footprint, mirror_dir))
    counts = sample_counts(across, up, np.full(mirror_dir.shape[:-1], sphere_map.texel_angle(size)))
    return samples(mirror_dir, across, up, counts)


def _warp_and_blend(
    views: RadianceViews, normal: Array, view_dir: Array, warping: Warping, fading: Fading
) -> tuple[Array, Array]:
    """Radiance of the three views around each view direction, by normal and by mirror, over albedo."""
    sources = find_triangle(views.sphere, view_dir)
    weights = barycentric_weights(view_dir, views.sphere.vertices[sources])
    table = albedo_table(views.albedo, warping)

    def blend(maps: Array, warp: Warp) -> Array:
        seen = _seen(views, warp, normal, view_dir, sources, fading)
        return _blend(maps, warp, table, sources, seen, weights)

    return _by_both_warps(views, warping, blend)


def _by_both_warps(
    views: RadianceViews, warping: Warping, blend: Callable[[Array, Warp], Array]
) -> tuple[Array, Array]:
    """What is blended by the normal, 0 where nothing is carried, and by the mirror direction."""
    blended = {
        warp: blend(maps, warp) for warp, maps in carried(views.diffuse, views.glossy, warping).items()
    }
    by_mirror = blended[Warp.MIRROR]
    return blended.get(Warp.NORMAL, np.zeros_like(by_mirror)), by_mirror


def _seen(
    views: RadianceViews, warp: Warp, normal: Array, view_dir: Array, sources: Indices, fading: Fading
) -> Array:
    """Where each of the three sources shows the surface points: u, v, cosine and trust, shape (..., 3, 4)."""
    normal, view_dir = normal[..., None, :], view_dir[..., None, :]
    uv = source_uv(warp, normal, view_dir, views.frames[sources])
    source_dirs = views.sphere.vertices[sources]
    cosine = source_cosine(warp, normal, view_dir, source_dirs)
    trust = source_trust(fading, warp, normal, view_dir, source_dirs)
    return np.concatenate([uv, cosine[..., None], trust[..., None]], axis=-1)


def _blend(maps: Array, warp: Warp, table: Array, sources: Indices, seen: Array, weights: Array) -> Array:
    """The sources' radiance over their albedo, each looked up at its own place, weighted and summed."""
    blended: Array = _weighted(maps, warp, table, sources, seen, weights).sum(axis=-2)
    return blended


def _weighted(maps: Array, warp: Warp, table: Array, sources: Indices, seen: Array, weights: Array) -> Array:
    """What each of the three sources adds, shape (..., 3, 3)."""
    cosine = seen[..., 2]
    # Weights times confidences, scaled to sum 1: [Cabral1999] section 4 divides by the accumulated sum.
    shares = weights * confidence(seen[..., 3])
    shares = shares / shares.sum(axis=-1, keepdims=True)
    radiance = bilinear(maps, seen[..., :2], sphere_map.wrap, layer=sources)
    weighted: Array = shares[..., None] * radiance / albedo_at(table, warp, cosine)
    return weighted


def _coloured(table: Array, seen: Seen, view_dir: Array, by_normal: Array, by_mirror: Array) -> Array:
    """The sum of both parts, each times its albedo, shape (..., 3)."""
    diffuse = by_normal * albedo_at(table, Warp.NORMAL, dot(seen.normal, view_dir))
    glossy: Array = by_mirror * albedo_at(table, Warp.MIRROR, dot(seen.mirror_normal, view_dir))
    return diffuse + glossy
