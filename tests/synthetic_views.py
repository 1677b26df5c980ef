"""Radiance views known in closed form: of a mirror and of a Lambert surface in a smooth environment.

The environment is a polynomial of second order in the direction, so what a Lambert surface reflects
is known too: cosine-weighted integration scales its bands 0, 1 and 2 by pi, 2 pi / 3 and pi / 4.
"""

from collections.abc import Callable

import numpy as np
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.geometry.camera import Camera
from rsibr.rsibr_addon.core.geometry.directions import camera_frame, normalize, reflect
from rsibr.rsibr_addon.core.geometry.geodesic import geodesic_sphere
from rsibr.rsibr_addon.core.kinds.radiance_views.views import RadianceViews
from rsibr.rsibr_addon.core.maps import sphere_map

CONSTANT = np.array([1.0, 0.8, 0.9])
SLOPES = np.array([[0.3, -0.4, 0.2], [0.5, 0.1, -0.2], [-0.1, 0.2, 0.6]])
AXES = np.array([[0.6, 0.8, 0.0], [0.0, 0.6, -0.8], [0.48, -0.6, 0.64]])
"""One row a channel: nothing is alike along any two axes, so no mix-up of axes goes unseen."""

Radiance = Callable[[np.ndarray], np.ndarray]


def environment_radiance(direction: np.ndarray) -> np.ndarray:
    """Incoming radiance, shape (..., 3), between 0.2 and 2.5."""
    return CONSTANT + direction @ SLOPES.T + (direction @ AXES.T) ** 2


def lambert_radiance(normal: np.ndarray) -> np.ndarray:
    """Radiance that a white Lambert surface reflects: irradiance / pi, shape (..., 3)."""
    second_band = (normal @ AXES.T) ** 2 - 1.0 / 3.0
    return CONSTANT + 1.0 / 3.0 + (2.0 / 3.0) * (normal @ SLOPES.T) + 0.25 * second_band


def mirror_maps(count: int, size: int) -> np.ndarray:
    """Maps of a perfect mirror, shape (count, size, size, 3), float32."""
    return _maps(count, lambda normal, view_dir: environment_radiance(reflect(view_dir, normal)), size)


def lambert_maps(count: int, size: int) -> np.ndarray:
    """Maps of a white Lambert sphere, shape (count, size, size, 3), float32."""
    return _maps(count, lambda normal, view_dir: lambert_radiance(normal), size)


def smooth_views(count: int, size: int) -> RadianceViews:
    """A coat over paint: Lambert radiance by the normal plus mirrored radiance by the mirror direction."""
    return RadianceViews(lambert_maps(count, size), mirror_maps(count, size))


def random_views(count: int, size: int) -> RadianceViews:
    """Texels without any pattern, in [0, 1]: what is looked up in the wrong place shows."""
    maps = np.random.default_rng(count * size).random((2, count, size, size, 3), dtype=np.float32)
    return RadianceViews(*maps)


def with_random_albedo(views: RadianceViews) -> RadianceViews:
    """The same maps with a table of albedo without any pattern, in [0.2, 1]."""
    table = np.random.default_rng(3).uniform(0.2, 1.0, (2, 16, 3)).astype(np.float32)
    return RadianceViews(views.diffuse, views.glossy, table)


def visible_points(camera: Camera, size: int, radius: float = 1.0) -> tuple[np.ndarray, np.ndarray]:
    """Normals and view directions at pixels of a picture of the unit sphere, shape (pixels, 3) each."""
    points = 2.0 * texel_centres(size, size).reshape(-1, 2) - 1.0
    points = points[np.linalg.norm(points, axis=-1) < radius]
    if camera.field_of_view is None:
        normal = sphere_map.normal_from_uv(0.5 * points + 0.5) @ camera.frame.T
        return normal, np.broadcast_to(camera.frame[:, 2], normal.shape)
    slope = np.tan(camera.field_of_view / 2.0)
    ray = normalize(np.c_[slope * points, -np.ones(len(points))]) @ camera.frame.T
    # |eye + t ray| = 1, the nearer of two.
    along = ray @ camera.eye[:3]
    reach = -along - np.sqrt(np.maximum(along**2 - camera.distance**2 + 1.0, 0.0))
    return normalize(camera.eye[:3] + reach[:, None] * ray), -ray


def interpolation_bound(by_uv: Radiance, size: int, radius: float) -> float:
    """Most that bilinear interpolation of a sphere map's texels errs within `radius` of the disk.

    Linear interpolation errs by at most h^2 / 8 times the second derivative, along each axis in turn.
    The derivatives are taken here as far as the texels that a lookup at `radius` may reach.
    """
    texel = 1.0 / size
    step = 1e-4
    radii, angles = np.meshgrid(np.linspace(0.0, radius + 3.0 * texel, 12), np.linspace(0.0, 2.0 * np.pi, 64))
    points = 0.5 + 0.5 * np.stack([radii * np.cos(angles), radii * np.sin(angles)], axis=-1)
    bound = 0.0
    for axis in np.eye(2):
        ahead, here, behind = (by_uv(points + shift * step * axis) for shift in (1, 0, -1))
        bound += texel**2 / 8.0 * np.abs(ahead - 2.0 * here + behind).max() / step**2
    return bound


def _maps(count: int, radiance: Callable[[np.ndarray, np.ndarray], np.ndarray], size: int) -> np.ndarray:
    sphere = geodesic_sphere(count)
    in_camera = sphere_map.normal_from_uv(texel_centres(size, size))
    normals = np.einsum("vij,stj->vsti", camera_frame(sphere.vertices), in_camera)
    return radiance(normals, sphere.vertices[:, None, None, :]).astype(np.float32)
