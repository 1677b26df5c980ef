"""The three modes against a reading of the paper by hand, closed forms, and each other."""

from collections.abc import Callable
from functools import cache
from math import floor

import numpy as np
import pytest
from rsibr.rsibr_addon.core.camera import Camera
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.directions import camera_frame, dot, normalize, reflect
from rsibr.rsibr_addon.core.disk_mesh import disk_mesh, interpolate
from rsibr.rsibr_addon.core.geodesic import barycentric_weights, find_triangle, geodesic_sphere
from rsibr.rsibr_addon.core.maps import sphere_map
from rsibr.rsibr_addon.core.radiance_views import RadianceViews
from rsibr.rsibr_addon.core.reflection_warp import Warp, confidence, source_cosine, source_uv
from rsibr.rsibr_addon.core.resample import bilinear
from rsibr.rsibr_addon.core.shading import (
    Destination,
    Warping,
    destination_by_mesh,
    destination_by_texel,
    destination_lookup,
    views_fragment,
)
from rsibr.tests.synthetic_views import (
    environment_radiance,
    interpolation_bound,
    lambert_maps,
    lambert_radiance,
    mirror_maps,
    random_views,
)

RNG = np.random.default_rng(12)
SIZE = 128
NEW_VIEWS = [tuple(d) for d in normalize([(1.0, -0.7, 0.4), (-0.2, 0.1, -1.0), (0.5, 0.6, 0.7)]).tolist()]
BY_MAP = pytest.mark.parametrize("destination", [destination_by_texel, destination_by_mesh])
WARPING = pytest.mark.parametrize("warping", Warping)
PAPERS_WARPINGS = (Warping.SINGLE, Warping.SPLIT)
"""Their maps hold radiance itself, not radiance over albedo."""

type MakeDestination = Callable[[RadianceViews, np.ndarray, int, Warping], Destination]


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


def radiance_by_hand(
    views: RadianceViews, normal: np.ndarray, view_dir: np.ndarray, warping: Warping
) -> np.ndarray:
    """[Cabral1999] sections 3.2-3.4 for one point, step by step, with the confidence of our docs."""
    for corners in views.sphere.triangles.tolist():
        a, b, c = views.sphere.vertices[corners]
        if min(np.linalg.det([view_dir, *pair]) for pair in ((a, b), (b, c), (c, a))) >= 0.0:
            break

    def area(u: np.ndarray, v: np.ndarray, w: np.ndarray) -> float:
        """[Cabral1999] section 3.4: dihedral angles less pi."""
        turns = zip((u, v, w), (v, w, u), (w, u, v), strict=True)
        angles = [np.arccos(normalize(np.cross(x, y)) @ normalize(np.cross(x, z))) for x, y, z in turns]
        return sum(angles) - np.pi

    weights = [area(view_dir, b, c), area(view_dir, c, a), area(view_dir, a, b)]
    whole = views.diffuse.astype(float) + views.glossy
    warps = [("n", views.diffuse), ("r", views.glossy)] if warping is not Warping.SINGLE else [("r", whole)]
    radiance = np.zeros(3)
    for central, maps in warps:
        total, share = np.zeros(3), 0.0
        for view, weight in zip(corners, weights, strict=True):
            right, up, back = camera_frame(views.sphere.vertices[view]).T
            direction = normal if central == "n" else 2.0 * (normal @ view_dir) * normal - view_dir
            x, y, z = right @ direction, up @ direction, back @ direction
            if central == "n" and z < 0.0:
                x, y = x / np.hypot(x, y), y / np.hypot(x, y)
            elif central == "r":
                x, y, z = normalize((x, y, z + 1.0))
            trust = min(max(z / 0.6, 1e-3), 1.0)
            total += weight * trust * tent(maps[view], 0.5 * x + 0.5, 0.5 * y + 0.5)
            share += weight * trust
        radiance += total / share
    return radiance


def tent(image: np.ndarray, s: float, t: float) -> np.ndarray:
    """Bilinear lookup of one point, within the edges."""
    x, y = len(image) * s - 0.5, len(image) * t - 0.5
    found = np.zeros(3)
    for row in (floor(y), floor(y) + 1):
        for column in (floor(x), floor(x) + 1):
            at, above = min(max(column, 0), len(image) - 1), min(max(row, 0), len(image) - 1)
            found += (1.0 - abs(x - column)) * (1.0 - abs(y - row)) * image[above, at].astype(float)
    return found


@WARPING
@pytest.mark.parametrize("count", [12, 42])
def test_each_step_of_the_paper_by_hand(count: int, warping: Warping) -> None:
    views = random_views(count, 8)
    view_dir = normalize(RNG.normal(size=(60, 3)))
    normal = normalize(view_dir + RNG.normal(size=(60, 3)))
    normal *= np.sign(dot(normal, view_dir))[:, None]
    ours = views_fragment(views, normal, view_dir, warping)
    by_hand = [radiance_by_hand(views, n, v, warping) for n, v in zip(normal, view_dir, strict=True)]
    # Single precision of the summed maps, a part in 2e7 of 2, is the largest error.
    np.testing.assert_allclose(ours, by_hand, atol=2e-7)


def test_the_warped_map_is_the_fragments_at_its_texels() -> None:
    views = random_views(42, 16)
    centres = texel_centres(24, 24)
    for view_dir in NEW_VIEWS:
        normal = sphere_map.normal_from_uv(centres) @ camera_frame(view_dir).T
        for warping in PAPERS_WARPINGS:
            made = destination_by_texel(views, view_dir, 24, warping)
            whole = made.by_normal + made.by_mirror
            np.testing.assert_allclose(whole, views_fragment(views, normal, view_dir, warping), atol=1e-12)
            inside = np.linalg.norm(2.0 * centres - 1.0, axis=-1) < 1.0
            # At a centre next to the rim, z = 0.2, the point is known to a few eps / z.
            looked_up = destination_lookup(made, normal[inside], np.asarray(view_dir))
            np.testing.assert_allclose(looked_up, whole[inside], atol=1e-12)


@pytest.mark.parametrize("warping", PAPERS_WARPINGS)
@pytest.mark.parametrize("count", [12, 42])
def test_a_captured_view_is_shown_as_it_was_captured(count: int, warping: Warping) -> None:
    size = 16
    views = random_views(count, size)
    centres = texel_centres(size, size)
    inside = np.linalg.norm(2.0 * centres - 1.0, axis=-1) < 1.0
    for view in range(0, count, count // 12):
        view_dir, frame = views.sphere.vertices[view], views.frames[view]
        parts = (
            (views.diffuse[view], views.glossy[view])
            if warping is not Warping.SINGLE
            else (0.0, views.combined[view])
        )
        captured = (parts[0] + parts[1].astype(float))[inside]
        normal = sphere_map.normal_from_uv(centres[inside]) @ frame.T
        # A mirror's place is known to a few eps / z, z > 0.1 here; times 16 texels of different radiance.
        np.testing.assert_allclose(views_fragment(views, normal, view_dir, warping), captured, atol=1e-12)
        for destination in (destination_by_texel, destination_by_mesh):
            made = destination(views, view_dir, size, warping)
            np.testing.assert_allclose((made.by_normal + made.by_mirror)[inside], captured, atol=1e-12)


@WARPING
def test_nothing_but_light_shows_in_even_light(warping: Warping) -> None:
    maps = np.ones((42, 5, 5, 3), np.float32)
    views = RadianceViews(0.25 * maps, 0.5 * maps)
    vertices = views.sphere.vertices
    special = np.concatenate([vertices, normalize(vertices[:12] + vertices[12:24]), np.eye(3), -np.eye(3)])
    view_dir = np.concatenate([special, normalize(RNG.normal(size=(500, 3)))])
    for normal in (
        view_dir,
        -view_dir,
        np.roll(view_dir, 1, axis=0),
        normalize(RNG.normal(size=view_dir.shape)),
    ):
        np.testing.assert_allclose(views_fragment(views, normal, view_dir, warping), 0.75, rtol=1e-14)
    for direction in special[::5]:
        for destination in (destination_by_texel, destination_by_mesh):
            made = destination(views, direction, 7, warping)
            np.testing.assert_allclose(destination_lookup(made, view_dir, direction), 0.75, rtol=1e-14)


@BY_MAP
def test_split_and_single_differ_by_the_diffuse_part_alone(destination: MakeDestination) -> None:
    views = random_views(12, 6)
    none = np.zeros_like(views.diffuse)
    normal, view_dir = visible_points(Camera(NEW_VIEWS[0], 1.0), 12)

    def shaded(diffuse: np.ndarray, glossy: np.ndarray, warping: Warping) -> list[np.ndarray]:
        chosen = RadianceViews(diffuse, glossy)
        made = destination(chosen, NEW_VIEWS[0], 9, warping)
        return [views_fragment(chosen, normal, view_dir, warping), destination_lookup(made, normal, view_dir)]

    whole = shaded(views.diffuse, views.glossy, Warping.SPLIT)
    by_normal, by_mirror = (
        shaded(views.diffuse, none, Warping.SPLIT),
        shaded(none, views.glossy, Warping.SPLIT),
    )
    single = shaded(none, views.glossy, Warping.SINGLE)
    moved = shaded(views.glossy, none, Warping.SINGLE)
    for i in range(2):
        np.testing.assert_allclose(whole[i], by_normal[i] + by_mirror[i], atol=1e-14)
        np.testing.assert_allclose(single[i], by_mirror[i], atol=1e-14)
        np.testing.assert_allclose(single[i], moved[i], atol=1e-14)
        assert np.abs(shaded(views.glossy, none, Warping.SPLIT)[i] - by_mirror[i]).max() > 0.1


@WARPING
def test_no_seam_between_triangles(warping: Warping) -> None:
    views = random_views(12, 8)
    a, b, c = np.moveaxis(views.sphere.vertices[views.sphere.triangles], 1, 0)
    on_edges = normalize(np.concatenate([0.3 * a + 0.7 * b, 0.8 * b + 0.2 * c, 0.5 * c + 0.5 * a]))
    across = normalize(np.concatenate([np.cross(a, b), np.cross(b, c), np.cross(c, a)]))
    normal = normalize(on_edges + 0.5 * normalize(RNG.normal(size=on_edges.shape)))
    step = 1e-9
    sides = [normalize(on_edges + sign * step * across) for sign in (1.0, -1.0)]
    assert np.all(
        np.any(find_triangle(views.sphere, sides[0]) != find_triangle(views.sphere, sides[1]), axis=1)
    )
    shown = [views_fragment(views, normal, side, warping) for side in sides]
    # Radiance changes by at most 2 a texel, 16 a unit of the map, and places by about a step.
    np.testing.assert_allclose(shown[0], shown[1], atol=100.0 * step)


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
        shares[:, i] *= confidence(source_cosine(warp, normal, view_dir, source))
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
            trust = confidence(source_cosine(Warp.MIRROR, disk_normal, frame[:, 2], source))
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


def test_equal_albedo_changes_nothing() -> None:
    views = random_views(12, 8)
    normal, view_dir = visible_points(Camera(NEW_VIEWS[0], 1.0), 12)
    for destination in (destination_by_texel, destination_by_mesh):
        shown = [
            destination_lookup(destination(views, NEW_VIEWS[0], 9, warping), normal, view_dir)
            for warping in (Warping.SPLIT, Warping.ALBEDO)
        ]
        np.testing.assert_allclose(*shown, rtol=1e-12)
    shown = [views_fragment(views, normal, view_dir, warping) for warping in (Warping.SPLIT, Warping.ALBEDO)]
    np.testing.assert_allclose(*shown, rtol=1e-12)


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
