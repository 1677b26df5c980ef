"""The geodesic sphere's part of gpu_shaders/lib against its numpy twin."""

from collections.abc import Callable

import numpy as np
import pytest
from rsibr.rsibr_addon.core.geometry import geodesic
from rsibr.rsibr_addon.core.geometry.directions import dot, normalize
from rsibr.rsibr_addon.core.geometry.geodesic import VERTEX_COUNTS, geodesic_sphere
from rsibr.rsibr_addon.core.geometry.view_sphere import view_sphere
from rsibr.rsibr_addon.device import buffers
from rsibr.rsibr_addon.device.kinds.radiance_views import _geodesic_texels
from rsibr.tests.glsl.evaluation import Samplers, evaluate
from rsibr.tests.glsl.twins import AXES, COUNT, Twin, check, single, unit_vectors


def triangles_and_directions(count: int) -> list[np.ndarray]:
    """Directions, vertices and middles of edges among them, and the corners of their triangles."""
    sphere = geodesic_sphere(count)
    a, b, c = np.moveaxis(sphere.vertices[sphere.triangles], 1, 0)
    edges = np.concatenate([sphere.vertices, normalize(a + b), normalize(0.9 * b + 0.1 * c), AXES])
    view_dir = unit_vectors(1, edges)
    corners = single(sphere.vertices[geodesic.find_triangle(sphere, view_dir)])
    return [view_dir, corners[:, 0], corners[:, 1], corners[:, 2]]


def geodesic_sampler(count: int) -> Callable[[], Samplers]:
    return lambda: {"sphere": ("FLOAT_2D", buffers.texture(_geodesic_texels(geodesic_sphere(count))))}


TWINS = {
    "spherical_excess": Twin(
        "geodesic_lib.glsl",
        "result_0.x = spherical_excess(in_0.xyz, in_1.xyz, in_2.xyz);",
        lambda: triangles_and_directions(12)[:3],
        lambda a, b, c: geodesic.spherical_excess(a, b, c)[:, None],
        # Products of unit vectors, and the driver's arctangent: 2e-5 of its value.
        lambda a, b, c: (1e-6 + 3e-5 * np.abs(geodesic.spherical_excess(a, b, c)))[:, None, None],
    ),
    "barycentric_weights": Twin(
        "geodesic_lib.glsl",
        "result_0.xyz = barycentric_weights(in_0.xyz, in_1.xyz, in_2.xyz, in_3.xyz);",
        lambda: triangles_and_directions(162),
        lambda view_dir, *corners: geodesic.barycentric_weights(view_dir, np.stack(corners, axis=1)),
        2e-5,
    ),
}


@pytest.mark.parametrize("name", TWINS)
def test_a_function_says_what_its_twin_says(name: str) -> None:
    check(TWINS[name])


@pytest.mark.parametrize("count", VERTEX_COUNTS)
def test_geodesic_vertex(count: int) -> None:
    index = np.arange(count, dtype=np.float64)[:, None]
    found = evaluate(
        "geodesic_lib.glsl",
        "result_0.xyz = geodesic_vertex(sphere, int(in_0.x));",
        [index],
        samplers=geodesic_sampler(count)(),
    )
    np.testing.assert_array_equal(found[:, 0, :3], single(geodesic_sphere(count).vertices))


def test_geodesic_corners() -> None:
    sphere = geodesic_sphere(42)
    found = evaluate(
        "geodesic_lib.glsl",
        "mat3 corners = geodesic_corners(sphere, ivec3(in_0.xyz));"
        "result_0.xyz = corners[0]; result_1.xyz = corners[1]; result_2.xyz = corners[2];",
        [single(sphere.triangles)],
        results=3,
        samplers=geodesic_sampler(42)(),
    )
    np.testing.assert_array_equal(found[:, :, :3], single(sphere.vertices[sphere.triangles]))


def test_geodesic_centre() -> None:
    index = np.arange(20, dtype=np.float64)[:, None]
    samplers = geodesic_sampler(42)()
    found = evaluate(
        "geodesic_lib.glsl",
        "result_0.xyz = geodesic_centre(sphere, int(in_0.x));",
        [index],
        samplers=samplers,
    )
    np.testing.assert_array_equal(found[:, 0, :3], single(geodesic_sphere(42).centres))


@pytest.mark.parametrize("count", VERTEX_COUNTS)
def test_geodesic_triangle(count: int) -> None:
    levels = geodesic_sphere(count).levels
    places = np.array([(level, i) for level, triangles in enumerate(levels) for i in range(len(triangles))])
    found = evaluate(
        "geodesic_lib.glsl",
        "result_0.xyz = vec3(geodesic_triangle(sphere, int(in_0.x), int(in_0.y)));",
        [places],
        samplers=geodesic_sampler(count)(),
    )
    np.testing.assert_array_equal(found[:, 0, :3], np.concatenate(levels))


@pytest.mark.parametrize("count", VERTEX_COUNTS)
def test_find_triangle(count: int) -> None:
    sphere = geodesic_sphere(count)
    view_dir = triangles_and_directions(count)[0]
    found = evaluate(
        "geodesic_lib.glsl",
        f"result_0.xyz = vec3(find_triangle(sphere, {len(sphere.levels) - 1}, in_0.xyz));",
        [view_dir],
        samplers=geodesic_sampler(count)(),
    )[:, 0, :3].astype(int)
    corners = sphere.vertices[found]
    beyond_edges = dot(np.cross(corners, np.roll(corners, -1, axis=1)), view_dir[:, None]).min(axis=-1)
    # A direction on an edge may fall to either side, by what rounding makes of a triple product.
    assert np.all(beyond_edges > -1e-6)
    clear = beyond_edges > 1e-6
    assert np.count_nonzero(clear) > 0.98 * COUNT
    np.testing.assert_array_equal(found[clear], geodesic.find_triangle(sphere, view_dir)[clear])


@pytest.mark.parametrize("count", [40, 3])
def test_find_triangle_between_any_views(count: int) -> None:
    """Triangles of a hull; and three views that are each alone."""
    sphere = view_sphere(np.random.default_rng(5).normal(size=(count, 3)))
    view_dir = unit_vectors(1)
    found = evaluate(
        "geodesic_lib.glsl",
        "result_0.xyz = vec3(find_triangle(sphere, 0, in_0.xyz));",
        [view_dir],
        samplers={"sphere": ("FLOAT_2D", buffers.texture(_geodesic_texels(sphere)))},
    )[:, 0, :3].astype(int)
    reach = np.sort(view_dir @ sphere.centres.T, axis=1)
    # Two facets are told apart by single precision
    clear = reach[:, -1] - reach[:, -2] > 1e-6 * reach[:, -1]
    assert np.count_nonzero(clear) > 0.98 * COUNT
    np.testing.assert_array_equal(found[clear], geodesic.find_triangle(sphere, view_dir)[clear])
