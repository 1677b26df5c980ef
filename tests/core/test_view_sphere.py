"""Triangles between any view directions, against the icosahedron's own and a search through all of them."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import RangeError, ShapeError
from rsibr.rsibr_addon.core.geometry.directions import dot, normalize
from rsibr.rsibr_addon.core.geometry.geodesic import (
    barycentric_weights,
    find_triangle,
    geodesic_sphere,
    spherical_excess,
)
from rsibr.rsibr_addon.core.geometry.view_sphere import MOST_VIEWS, view_sphere

RNG = np.random.default_rng(18)
DIRECTIONS = normalize(RNG.normal(size=(2000, 3)))
TURN = np.linalg.qr(RNG.normal(size=(3, 3)))[0]
CUBE = np.array([(x, y, z) for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
SETS = {
    "icosahedron, turned": geodesic_sphere(12).vertices @ TURN.T,
    "162, turned": geodesic_sphere(162).vertices @ TURN.T,
    "cube": CUBE,
    "axes": np.concatenate([np.eye(3), -np.eye(3)]),
    "tetrahedron": CUBE[[0, 3, 5, 6]],
    "uneven": normalize(RNG.normal(size=(40, 3)) + (0.0, 0.0, 0.5)),
}
BY_SET = pytest.mark.parametrize("view_dirs", SETS.values(), ids=SETS)


@BY_SET
def test_the_triangles_tile_the_sphere(view_dirs: np.ndarray) -> None:
    sphere = view_sphere(view_dirs)
    np.testing.assert_allclose(sphere.vertices, normalize(view_dirs), atol=1e-15)
    assert sphere.surrounds
    assert len(sphere.triangles) == 2 * len(view_dirs) - 4
    areas = spherical_excess(*np.moveaxis(sphere.vertices[sphere.triangles], 1, 0))
    assert areas.min() > 0.0
    assert areas.sum() == pytest.approx(4.0 * np.pi, rel=1e-12)


@BY_SET
def test_the_triangle_found_holds_the_direction(view_dirs: np.ndarray) -> None:
    sphere = view_sphere(view_dirs)
    a, b, c = np.moveaxis(sphere.vertices[find_triangle(sphere, DIRECTIONS)], -2, 0)
    for one, other in ((a, b), (b, c), (c, a)):
        # Triangles whose corners lie on a circle are told by a lift of 1e-4, known to 1e-16
        assert dot(DIRECTIONS, np.cross(one, other)).min() > -1e-10


def test_an_icosahedron_is_known_whatever_way_it_stands() -> None:
    ours, known = view_sphere(SETS["icosahedron, turned"]), geodesic_sphere(12)
    triangles = [{frozenset(each) for each in sphere.triangles.tolist()} for sphere in (ours, known)]
    assert triangles[0] == triangles[1]
    rounded = np.round(geodesic_sphere(42).vertices, 6)
    assert view_sphere(rounded) is geodesic_sphere(42)


@pytest.mark.parametrize(
    "view_dirs",
    [[(0.0, 0.0, 2.0)], np.eye(3), [(np.cos(t), np.sin(t), 0.0) for t in range(6)], CUBE[CUBE[:, 0] > 0.0]],
    ids=["one", "three", "a circle", "one side"],
)
def test_directions_that_do_not_surround_are_each_alone(view_dirs: np.ndarray) -> None:
    sphere = view_sphere(view_dirs)
    assert not sphere.surrounds
    found = find_triangle(sphere, DIRECTIONS)
    nearest = np.argmax(DIRECTIONS @ sphere.vertices.T, axis=-1)
    np.testing.assert_array_equal(found, np.repeat(nearest[:, None], 3, axis=1))
    weights = barycentric_weights(DIRECTIONS, sphere.vertices[found])
    np.testing.assert_array_equal(weights, np.full((len(DIRECTIONS), 3), 1.0 / 3.0))


def test_vectors_of_any_length_are_directions() -> None:
    lengths = np.array([1e-300, 1e300, 1.0])[:, None]
    np.testing.assert_allclose(view_sphere(lengths * np.eye(3)).vertices, np.eye(3), atol=1e-15)


@pytest.mark.parametrize(
    ("view_dirs", "error", "message"),
    [
        (np.zeros((0, 3)), ShapeError, "three numbers, one or more"),
        (np.ones((4, 2)), ShapeError, "three numbers"),
        (RNG.normal(size=(MOST_VIEWS + 1, 3)), RangeError, "163 view directions: give 162 at most"),
        ([(0.0, 0.0, 0.0), (0.0, 0.0, 1.0)], RangeError, "is 0 or not finite"),
        ([(0.0, 0.0, np.nan)], RangeError, "is 0 or not finite"),
        ([(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (1.0, 0.01, 0.0)], RangeError, "directions 1 and 3 are nearer"),
    ],
)
def test_sets_that_are_none_are_refused(view_dirs: object, error: type[Exception], message: str) -> None:
    with pytest.raises(error, match=message):
        view_sphere(view_dirs)
