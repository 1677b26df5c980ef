"""The tessellated disk and the interpolation over it, against a search through all triangles."""

import numpy as np
from rsibr.rsibr_addon.core.geometry.disk_mesh import MARGIN, RINGS, SECTORS, disk_mesh, interpolate

RNG = np.random.default_rng(10)


def points_within(radius: float, count: int = 150) -> np.ndarray:
    angle = RNG.uniform(0.0, 2.0 * np.pi, count)
    return radius * np.sqrt(RNG.random(count))[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=-1)


POINTS = np.concatenate([points_within(1.0), points_within(0.05), [(0.0, 0.0), (1.0, 0.0), (0.0, -1.0)]])


def doubled_areas() -> np.ndarray:
    mesh = disk_mesh()
    a, b, c = np.moveaxis(mesh.positions[mesh.triangles], 1, 0)
    return np.linalg.det(np.stack([b - a, c - a], axis=-1))


def test_it_covers_the_disk_and_its_margin_once() -> None:
    areas = doubled_areas() / 2.0
    solid = areas > 1e-12
    assert np.all(areas[~solid] == 0.0)  # where sectors meet at the centre
    assert np.count_nonzero(~solid) == SECTORS
    polygon = 0.5 * SECTORS * np.sin(2.0 * np.pi / SECTORS) * MARGIN**2
    np.testing.assert_allclose(areas.sum(), polygon, rtol=1e-13)
    triangles = disk_mesh().triangles[solid]
    edges = np.sort(
        np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1
    )
    different, sides = np.unique(edges, axis=0, return_counts=True)
    assert np.count_nonzero(sides == 1) == SECTORS  # the outline; every other edge has two sides
    assert set(sides) == {1, 2}
    assert len(disk_mesh().positions) - len(different) + len(triangles) == 1


def test_it_is_finer_towards_the_rim() -> None:
    radii = np.linalg.norm(disk_mesh().positions[1:], axis=-1).reshape(RINGS + 1, SECTORS)
    np.testing.assert_allclose(radii, np.broadcast_to(radii[:, :1], radii.shape), rtol=1e-14)
    widths = np.diff(radii[:RINGS, 0], prepend=0.0)
    assert np.all(np.diff(widths) < 0.0)
    assert radii[RINGS - 1, 0] == 1.0


def test_the_margin_holds_a_texel_beyond_the_rim() -> None:
    # A lookup at the rim reaches one texel along each axis: here of a map of 12 texels over [-1, 1].
    assert MARGIN * np.cos(np.pi / SECTORS) > 1.0 + np.sqrt(2.0) * 2.0 / 12.0


def test_planes_are_kept() -> None:
    slopes = np.array([[3.0, -1.0, 0.0], [2.0, 5.0, 0.0]])
    values = disk_mesh().positions @ slopes + (1.0, -0.5, 7.0)
    in_margin = points_within(0.99 * MARGIN)
    for points in (POINTS, in_margin, disk_mesh().positions[: 1 + RINGS * SECTORS]):
        np.testing.assert_allclose(
            interpolate(points, values), points @ slopes + (1.0, -0.5, 7.0), atol=1e-12
        )


def test_values_are_those_of_the_triangle_that_a_search_finds() -> None:
    mesh = disk_mesh()
    values = RNG.random((len(mesh.positions), 2))
    triangles = mesh.triangles[doubled_areas() > 0.0]
    a, b, c = np.moveaxis(mesh.positions[triangles], 1, 0)
    inverse = np.linalg.inv(np.stack([b - a, c - a], axis=-1))
    points = np.concatenate([POINTS, points_within(0.99 * MARGIN, 100)])
    along = np.einsum("fij,pfj->pfi", inverse, points[:, None] - a)
    weights = np.concatenate([1.0 - along.sum(axis=-1, keepdims=True), along], axis=-1)
    holding = np.argmax(weights.min(axis=-1), axis=-1)
    weight = weights[np.arange(len(points)), holding]
    assert weight.min() > -1e-9
    expected = np.einsum("pi,pic->pc", weight, values[triangles[holding]])
    np.testing.assert_allclose(interpolate(points, values), expected, atol=1e-9)


def test_vertices_show_their_own_values() -> None:
    mesh = disk_mesh()
    values = RNG.random((len(mesh.positions), 3))
    inner = slice(0, 1 + RINGS * SECTORS)
    np.testing.assert_allclose(interpolate(mesh.positions[inner], values), values[inner], atol=1e-10)


def test_any_shape_of_points() -> None:
    values = RNG.random((len(disk_mesh().positions), 3))
    points = POINTS[:12].reshape(3, 4, 2)
    np.testing.assert_array_equal(
        interpolate(points, values).reshape(12, 3), interpolate(POINTS[:12], values)
    )
