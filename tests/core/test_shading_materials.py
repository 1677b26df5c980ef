"""The three modes against materials known in closed form."""

from collections.abc import Callable
from functools import cache

import numpy as np
import pytest
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.geometry.camera import Camera
from rsibr.rsibr_addon.core.geometry.directions import camera_frame, dot, normalize, reflect
from rsibr.rsibr_addon.core.geometry.disk_mesh import disk_mesh, interpolate
from rsibr.rsibr_addon.core.geometry.geodesic import barycentric_weights, find_triangle, geodesic_sphere
from rsibr.rsibr_addon.core.geometry.reflection_warp import Fading, Warp, confidence, source_trust, source_uv
from rsibr.rsibr_addon.core.kinds.radiance_views.shading import (
    Destination,
    destination_by_mesh,
    destination_by_texel,
    destination_lookup,
    views_fragment,
)
from rsibr.rsibr_addon.core.kinds.radiance_views.views import RadianceViews
from rsibr.rsibr_addon.core.kinds.radiance_views.warping import Warping
from rsibr.rsibr_addon.core.maps import sphere_map
from rsibr.rsibr_addon.core.resample import bilinear
from rsibr.tests.synthetic_views import (
    environment_radiance,
    interpolation_bound,
    lambert_maps,
    lambert_radiance,
    mirror_maps,
    visible_points,
)

SIZE = 128
NEW_VIEWS = [tuple(d) for d in normalize([(1.0, -0.7, 0.4), (-0.2, 0.1, -1.0), (0.5, 0.6, 0.7)]).tolist()]
BY_MAP = pytest.mark.parametrize("destination", [destination_by_texel, destination_by_mesh])

MakeDestination = Callable[[RadianceViews, np.ndarray, int, Warping], Destination]


RADII = (0.5, 0.7, 0.8, 0.9, 0.95, 0.97)
BRIGHTEST = 2.5


def mirrored(normal: np.ndarray, view_dir: np.ndarray) -> np.ndarray:
    return environment_radiance(reflect(view_dir, normal))


def matt(normal: np.ndarray, _view_dir: np.ndarray) -> np.ndarray:
    return lambert_radiance(normal)


MATERIALS = {Warp.MIRROR: mirrored, Warp.NORMAL: matt}


@cache
def interpolation_errors(warp: Warp) -> list[float]:
    """Most that the maps of a material err by interpolation: within each of RADII, and beyond."""
    bounds = np.zeros(len(RADII))
    for frame in camera_frame(geodesic_sphere(12).vertices):

        def by_uv(uv: np.ndarray, frame: np.ndarray = frame) -> np.ndarray:
            return MATERIALS[warp](sphere_map.normal_from_uv(uv) @ frame.T, frame[:, 2])

        bounds = np.maximum(bounds, [interpolation_bound(by_uv, SIZE, radius) for radius in RADII])
    return [*bounds.tolist(), BRIGHTEST]


def only(warp: Warp, size: int) -> RadianceViews:
    """Views of a mirror or of a Lambert sphere alone."""
    black = np.zeros((12, size, size, 3), np.float32)
    if warp is Warp.MIRROR:
        return RadianceViews(black, mirror_maps(12, size))
    return RadianceViews(lambert_maps(12, size), black)


def promised_error(warp: Warp, normal: np.ndarray, view_dir: np.ndarray) -> np.ndarray:
    """Shares of the three sources times what each may err at the radius at which it is looked up."""
    sphere = geodesic_sphere(12)
    sources = find_triangle(sphere, view_dir)
    shares = barycentric_weights(view_dir, sphere.vertices[sources])
    errors = np.empty_like(shares)
    for i in range(3):
        source = sphere.vertices[sources[:, i]]
        uv = source_uv(warp, normal, view_dir, camera_frame(source))
        shares[:, i] *= confidence(source_trust(Fading.COSINE, warp, normal, view_dir, source))
        errors[:, i] = np.take(
            interpolation_errors(warp), np.searchsorted(RADII, np.linalg.norm(2.0 * uv - 1.0, axis=-1))
        )
    shares /= shares.sum(axis=-1, keepdims=True)
    # The maps are single precision.
    return np.sum(shares * errors, axis=-1) + BRIGHTEST * 6e-8


@pytest.mark.parametrize("warp", Warp)
@pytest.mark.parametrize("field_of_view", [None, 1.0], ids=["orthographic", "perspective"])
def test_a_known_material_from_new_views(warp: Warp, field_of_view: float | None) -> None:
    views = only(warp, SIZE)
    for direction in NEW_VIEWS:
        normal, view_dir = visible_points(Camera(direction, field_of_view), 40)
        truth = MATERIALS[warp](normal, view_dir)
        promised = promised_error(warp, normal, view_dir)
        error = np.abs(views_fragment(views, normal, view_dir, Warping.SPLIT) - truth).max(axis=-1)
        assert np.all(error <= promised)
        # The promise is worth something: a few parts in a thousand over most of the picture.
        assert np.median(promised) < 4e-3


@BY_MAP
@pytest.mark.parametrize("field_of_view", [None, 1.0], ids=["orthographic", "perspective"])
def test_a_mirror_by_way_of_a_map(destination: MakeDestination, field_of_view: float | None) -> None:
    views = only(Warp.MIRROR, SIZE)
    for direction in NEW_VIEWS:
        made = destination(views, direction, SIZE, Warping.SINGLE)
        normal, view_dir = visible_points(Camera(direction, field_of_view), 40)
        error = np.abs(destination_lookup(made, normal, view_dir) - mirrored(normal, view_dir)).max(axis=-1)
        # What each texel of the map may err, and what interpolation between them adds.
        texel_error = promised_texel_error(direction, flat=destination is destination_by_mesh)
        uv = sphere_map.uv_from_direction(reflect(view_dir, normal) @ made.frame)
        radius = np.linalg.norm(2.0 * uv - 1.0, axis=-1)
        promised = bilinear(texel_error[..., None], uv, sphere_map.wrap)[..., 0]
        promised += np.take(interpolation_errors(Warp.MIRROR), np.searchsorted(RADII, radius))
        assert np.all(error <= promised)
        assert np.median(promised) < 1e-2


@cache
def promised_texel_error(direction: tuple[float, float, float], flat: bool) -> np.ndarray:
    """Most that each texel of a mirror's destination map may err, shape (SIZE, SIZE).

    `flat` adds what a source looked up at a place interpolated over the disk differs from one looked up
    at the right place.
    """
    sphere, frame = geodesic_sphere(12), camera_frame(direction)
    uv = texel_centres(SIZE, SIZE).reshape(-1, 2)
    normal = sphere_map.normal_from_uv(uv) @ frame.T
    view_dir = np.broadcast_to(frame[:, 2], normal.shape)
    error = promised_error(Warp.MIRROR, normal, view_dir)
    error[np.linalg.norm(2.0 * uv - 1.0, axis=-1) > 1.0] = BRIGHTEST
    if flat:
        seen = error < BRIGHTEST
        sources = find_triangle(sphere, frame[:, 2])
        weights = barycentric_weights(frame[:, 2], sphere.vertices[sources])
        disk_normal = sphere_map.normal_from_uv(0.5 * disk_mesh().positions + 0.5) @ frame.T
        truth = mirrored(normal[seen], view_dir[seen])
        total, share = 0.0, 0.0
        for source, weight in zip(sphere.vertices[sources], weights, strict=True):
            source_frame = camera_frame(source)
            trust = confidence(source_trust(Fading.COSINE, Warp.MIRROR, disk_normal, frame[:, 2], source))
            place = source_uv(Warp.MIRROR, disk_normal, frame[:, 2], source_frame)
            place, trust = np.split(interpolate(2.0 * uv[seen] - 1.0, np.c_[place, trust]), [2], axis=-1)
            shown = mirrored(sphere_map.normal_from_uv(place) @ source_frame.T, source)
            total += weight * trust[:, 0] * np.abs(shown - truth).max(axis=-1)
            share += weight * trust[:, 0]
        error[seen] += total / share
    return error.reshape(SIZE, SIZE)


def test_in_perspective_only_fragments_know_their_own_view() -> None:
    # A Lambert sphere under a single warp, seen along a captured view.
    views = RadianceViews(lambert_maps(42, 64), np.zeros((42, 64, 64, 3), np.float32))
    captured = views.sphere.vertices[3]
    normal, view_dir = visible_points(Camera(tuple(captured.tolist()), np.deg2rad(90.0)), 40, radius=0.9)

    def error(shown: np.ndarray) -> float:
        return float(np.sqrt(np.mean((shown - lambert_radiance(normal)) ** 2)))

    by_fragment = error(views_fragment(views, normal, view_dir, Warping.SINGLE))
    half_dir = normalize(reflect(view_dir, normal) + captured)
    for destination in (destination_by_texel, destination_by_mesh):
        shown = destination_lookup(destination(views, captured, 64, Warping.SINGLE), normal, view_dir)
        # A map of one view shows what is mirrored there where that view, not the fragment's own, mirrors it.
        radius = np.sqrt(1.0 - (half_dir @ captured) ** 2)
        at_half_resolution = 4.0 * np.array(interpolation_errors(Warp.NORMAL))
        promised = at_half_resolution[np.searchsorted(RADII, radius)]
        assert np.all(np.abs(shown - lambert_radiance(half_dir)).max(axis=-1) < promised)
        # That is off by half the angle between the views, up to 22 degrees; blending views that stand 32
        # to 36 degrees apart errs in the second order of that only.
        assert by_fragment < 0.25 * error(shown)


def fresnel(cosine: np.ndarray) -> np.ndarray:
    """A reflectance that differs between channels, and changes by 17 times from edge on to face on."""
    grazing = 1.0 - np.clip(cosine, 0.0, 1.0)[..., None]
    return np.array([0.06, 0.1, 0.2]) + np.array([0.94, 0.9, 0.8]) * grazing**5


def coated_views(size: int) -> RadianceViews:
    """A mirror with `fresnel`'s reflectance over a black base, and its albedo."""
    cosine = sphere_map.normal_from_uv(texel_centres(size, size))[..., 2]
    glossy = (mirror_maps(12, size) * fresnel(cosine)).astype(np.float32)
    table = fresnel((np.arange(256) + 0.5) / 256.0)
    return RadianceViews(np.zeros_like(glossy), glossy, np.stack([np.zeros_like(table), table]))


@pytest.mark.parametrize("field_of_view", [None, 1.0], ids=["orthographic", "perspective"])
def test_with_its_albedo_a_coat_is_as_good_as_a_mirror(field_of_view: float | None) -> None:
    views = coated_views(SIZE)
    for direction in NEW_VIEWS:
        normal, view_dir = visible_points(Camera(direction, field_of_view), 40, radius=0.95)
        truth = mirrored(normal, view_dir) * fresnel(dot(normal, view_dir))

        def error(warping: Warping) -> float:
            shown = views_fragment(views, normal, view_dir, warping)  # noqa: B023
            return float(np.sqrt(np.mean((shown - truth) ** 2) / np.mean(truth**2)))  # noqa: B023

        # LEAST_ALBEDO leaves up to 1e-3 / 0.06 of the difference between two albedos; the table and the
        # maps, looked up where Fresnel's curve is steep, a few parts in a thousand.
        assert error(Warping.ALBEDO) < 0.02
        assert error(Warping.SPLIT) > 5.0 * error(Warping.ALBEDO)
