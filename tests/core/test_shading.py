"""The three modes against a reading of the paper by hand, and against each other."""

from collections.abc import Callable
from math import floor

import numpy as np
import pytest
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.geometry.camera import Camera
from rsibr.rsibr_addon.core.geometry.directions import camera_frame, dot, normalize
from rsibr.rsibr_addon.core.geometry.geodesic import find_triangle
from rsibr.rsibr_addon.core.geometry.reflection_warp import Fading
from rsibr.rsibr_addon.core.kinds.radiance_views.shading import (
    Destination,
    destination_by_mesh,
    destination_by_texel,
    destination_lookup,
    source_shares,
    views_fragment,
)
from rsibr.rsibr_addon.core.kinds.radiance_views.views import RadianceViews
from rsibr.rsibr_addon.core.kinds.radiance_views.warping import LEAST_ALBEDO, Warping
from rsibr.rsibr_addon.core.maps import sphere_map
from rsibr.tests.synthetic_views import (
    random_views,
    visible_points,
    with_random_albedo,
)

RNG = np.random.default_rng(12)
NEW_VIEWS = [tuple(d) for d in normalize([(1.0, -0.7, 0.4), (-0.2, 0.1, -1.0), (0.5, 0.6, 0.7)]).tolist()]
BY_MAP = pytest.mark.parametrize("destination", [destination_by_texel, destination_by_mesh])
WARPING = pytest.mark.parametrize("warping", Warping)
PAPERS_WARPINGS = (Warping.SINGLE, Warping.SPLIT)
"""Their maps hold radiance itself, not radiance over albedo."""

MakeDestination = Callable[[RadianceViews, np.ndarray, int, Warping], Destination]


def radiance_by_hand(
    views: RadianceViews, normal: np.ndarray, view_dir: np.ndarray, warping: Warping, fading: Fading
) -> np.ndarray:
    """[Cabral1999] sections 3.2-3.4 for one point, step by step, with a confidence of our docs."""
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
    parts = [("n", views.diffuse, views.albedo[0]), ("r", views.glossy, views.albedo[1])]
    if warping is Warping.SINGLE:
        parts = [("r", whole, views.albedo[1])]

    def albedo(table: np.ndarray, cosine: float) -> np.ndarray:
        """Linear between the table's columns, and what keeps a division possible; 1 in the paper."""
        columns = (np.arange(len(table)) + 0.5) / len(table)
        found = np.array([np.interp(cosine, columns, channel) for channel in table.T]) + LEAST_ALBEDO
        return found if warping is Warping.ALBEDO else np.ones(3)

    radiance = np.zeros(3)
    for central, maps, table in parts:
        total, share = np.zeros(3), 0.0
        for view, weight in zip(corners, weights, strict=True):
            right, up, back = camera_frame(views.sphere.vertices[view]).T
            direction = normal if central == "n" else 2.0 * (normal @ view_dir) * normal - view_dir
            x, y, z = right @ direction, up @ direction, back @ direction
            if central == "n" and z < 0.0:
                x, y = x / np.hypot(x, y), y / np.hypot(x, y)
            elif central == "r":
                x, y, z = normalize((x, y, z + 1.0))
            trust = z / 0.6
            if central == "r" and fading is Fading.DISTANCE:
                pinched = normalize(view_dir - back)
                axes = camera_frame(view_dir).T[:2]
                trust = np.linalg.norm(axes @ normal - axes @ pinched)
            trust = min(max(trust, 1e-3), 1.0)
            total += weight * trust * tent(maps[view], 0.5 * x + 0.5, 0.5 * y + 0.5) / albedo(table, z)
            share += weight * trust
        radiance += albedo(table, normal @ view_dir) * total / share
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
@pytest.mark.parametrize(("count", "fading"), [(12, Fading.DISTANCE), (42, Fading.COSINE)])
def test_each_step_of_the_paper_by_hand(count: int, fading: Fading, warping: Warping) -> None:
    views = with_random_albedo(random_views(count, 8))
    view_dir = normalize(RNG.normal(size=(60, 3)))
    normal = normalize(view_dir + RNG.normal(size=(60, 3)))
    normal *= np.sign(dot(normal, view_dir))[:, None]
    ours = views_fragment(views, normal, view_dir, warping, fading=fading)
    by_hand = [radiance_by_hand(views, n, v, warping, fading) for n, v in zip(normal, view_dir, strict=True)]
    # Single precision of the summed maps and of the table, a part in 2e7, over an albedo of 0.2 or more.
    np.testing.assert_allclose(ours, by_hand, atol=1e-6)


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


@WARPING
@pytest.mark.parametrize("count", [12, 42])
def test_a_captured_view_is_shown_as_it_was_captured(count: int, warping: Warping) -> None:
    size = 16
    views = with_random_albedo(random_views(count, size))
    centres = texel_centres(size, size)
    inside = np.linalg.norm(2.0 * centres - 1.0, axis=-1) < 1.0
    for view in range(0, count, count // 12):
        view_dir, frame = views.sphere.vertices[view], views.frames[view]
        captured = views.diffuse[view, inside].astype(float) + views.glossy[view, inside]
        normal = sphere_map.normal_from_uv(centres[inside]) @ frame.T
        shown = [views_fragment(views, normal, view_dir, warping)]
        shown.append(
            destination_lookup(destination_by_texel(views, view_dir, size, warping), normal, view_dir)
        )
        # The disk interpolates places exactly here, where they do not move, but cosines it does not.
        if warping is not Warping.ALBEDO:
            made = destination_by_mesh(views, view_dir, size, warping)
            shown.append(destination_lookup(made, normal, view_dir))
        # A mirror's place is known to a few eps / z, z > 0.1 here; times 16 texels of different radiance.
        # A single warp looks up a sum in single precision.
        tolerance = 1.3e-7 if warping is Warping.SINGLE else 1e-12
        np.testing.assert_allclose(shown, np.broadcast_to(captured, np.shape(shown)), atol=tolerance)


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


@WARPING
def test_what_three_sources_add_is_the_view(warping: Warping) -> None:
    views = with_random_albedo(random_views(42, 8))
    for view_dir in NEW_VIEWS:
        sources, shares = source_shares(views, view_dir, 12, warping)
        np.testing.assert_array_equal(sources, find_triangle(views.sphere, view_dir))
        normal = sphere_map.normal_from_uv(texel_centres(12, 12)) @ camera_frame(view_dir).T
        # Beyond the disk normals are cut off at its rim, where a fragment sees the surface from its side
        inside = np.linalg.norm(2.0 * texel_centres(12, 12) - 1.0, axis=-1) < 1.0
        whole = views_fragment(views, normal[inside], np.asarray(view_dir), warping)
        np.testing.assert_allclose(shares.sum(axis=0)[inside], whole, atol=1e-12)


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
