"""The sphere map: g_normal, g_mirror and their inverses, solid angles, and the rim's filling."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.errors import ShapeError
from rsibr.rsibr_addon.core.geometry.directions import normalize, reflect
from rsibr.rsibr_addon.core.maps import sphere_map
from rsibr.rsibr_addon.core.resample import bilinear

RNG = np.random.default_rng(6)
DIRECTIONS = normalize(RNG.normal(size=(5000, 3)))
ANGLES = np.linspace(0.0, 2.0 * np.pi, 33)
RIM = np.stack([np.cos(ANGLES), np.sin(ANGLES)], axis=-1)
EPS = np.finfo(np.float64).eps


def points_of_the_disk() -> np.ndarray:
    """(s, t) of random points, of the centre and of points that crowd towards the rim."""
    radii = np.concatenate([np.sqrt(RNG.random(5000)), [0.0], 1.0 - 10.0 ** np.linspace(-12.0, -1.0, 50)])
    angles = RNG.uniform(0.0, 2.0 * np.pi, radii.size)
    return 0.5 + 0.5 * radii[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=-1)


def test_g_normal_is_the_paper_s() -> None:
    s, t = texel_centres(33, 33).reshape(-1, 2)[::7].T
    s, t = s[(2 * s - 1) ** 2 + (2 * t - 1) ** 2 < 1], t[(2 * s - 1) ** 2 + (2 * t - 1) ** 2 < 1]
    expected = np.stack([2 * s - 1, 2 * t - 1, np.sqrt(1 - (2 * s - 1) ** 2 - (2 * t - 1) ** 2)], axis=-1)
    np.testing.assert_allclose(sphere_map.normal_from_uv(np.stack([s, t], axis=-1)), expected, atol=1e-15)
    # The right of the map is the camera's x, its top the camera's y, its centre faces the camera.
    np.testing.assert_array_equal(sphere_map.normal_from_uv([(1.0, 0.5), (0.5, 1.0), (0.5, 0.5)]), np.eye(3))


def test_g_mirror_reflects_the_camera_s_direction() -> None:
    uv = points_of_the_disk()
    mirrored = reflect((0.0, 0.0, 1.0), sphere_map.normal_from_uv(uv))
    np.testing.assert_allclose(sphere_map.direction_from_uv(uv), mirrored, atol=1e-15)


def test_points_are_found_again() -> None:
    uv = points_of_the_disk()
    normal = sphere_map.normal_from_uv(uv)
    np.testing.assert_allclose(np.linalg.norm(normal, axis=-1), 1.0, atol=2.0 * EPS)
    np.testing.assert_allclose(sphere_map.uv_from_normal(normal), uv, atol=2.0 * EPS)
    # The half vector has length 2 z and is known to a few eps.
    error = np.abs(sphere_map.uv_from_direction(sphere_map.direction_from_uv(uv)) - uv).max(axis=-1)
    assert np.all(error < 4.0 * EPS / normal[:, 2])


def test_normals_and_directions_are_found_again() -> None:
    seen = DIRECTIONS * np.where(DIRECTIONS[:, 2:] < 0.0, (1.0, 1.0, -1.0), 1.0)
    found = sphere_map.normal_from_uv(sphere_map.uv_from_normal(seen))
    # z is the root of what x and y leave of 1: an error of eps becomes eps / z, and sqrt(eps) at most.
    assert np.all(np.abs(found - seen).max(axis=-1) < 4.0 * EPS / np.maximum(seen[:, 2], np.sqrt(EPS)))
    near_singularity = normalize(
        np.stack([*(0.5 ** np.arange(1, 40) * [[0.6], [-0.8]]), -np.ones(39)], axis=-1)
    )
    directions = np.concatenate([DIRECTIONS, near_singularity])
    found = sphere_map.direction_from_uv(sphere_map.uv_from_direction(directions))
    # Here z of the normal is the cosine of half the angle to the camera; a direction turns twice as fast.
    half_cosine = np.linalg.norm(directions + (0.0, 0.0, 1.0), axis=-1) / 2.0
    error = np.abs(found - directions).max(axis=-1)
    assert np.all(error < 8.0 * EPS / np.maximum(half_cosine, np.sqrt(EPS)))


def test_the_rim() -> None:
    on_rim = 0.5 + 0.5 * RIM
    normals = sphere_map.normal_from_uv(on_rim)
    np.testing.assert_allclose(normals[:, :2], RIM, atol=2.0 * EPS)
    np.testing.assert_allclose(normals[:, 2], 0.0, atol=2.0 * np.sqrt(EPS))
    np.testing.assert_allclose(sphere_map.uv_from_normal(normals), on_rim, atol=2.0 * EPS)
    np.testing.assert_allclose(
        sphere_map.direction_from_uv(on_rim), np.broadcast_to((0, 0, -1.0), (33, 3)), atol=4.0 * np.sqrt(EPS)
    )
    # Points outside stand for the nearest point of the rim, the corners of the map too.
    outside = 0.5 + 0.5 * RIM * np.linspace(1.0, 1.6, 33)[:, None]
    np.testing.assert_allclose(sphere_map.normal_from_uv(outside)[:, :2], RIM, atol=4.0 * EPS)


def test_normals_that_face_away_go_to_the_rim() -> None:
    hidden = normalize(np.concatenate([RIM, -np.linspace(1e-6, 50.0, 33)[:, None]], axis=-1))
    np.testing.assert_allclose(sphere_map.uv_from_normal(hidden), 0.5 + 0.5 * RIM, atol=1e-14)
    np.testing.assert_array_equal(sphere_map.uv_from_normal((0.0, 0.0, -1.0)), (1.0, 0.5))


def test_the_singularity_has_one_answer() -> None:
    np.testing.assert_array_equal(sphere_map.uv_from_direction((0.0, 0.0, -1.0)), (1.0, 0.5))


@pytest.mark.parametrize("size", [1, 2, 3, 8, 31])
def test_solid_angles(size: int) -> None:
    solid_angle = sphere_map.texel_solid_angle(size)
    assert solid_angle.shape == (size, size)
    assert solid_angle.sum() == pytest.approx(4.0 * np.pi, rel=1e-13)
    # Count points of a grid within the disk; those a rim passes may be miscounted: 3 steps a texel.
    steps = 40
    inside = np.linalg.norm(2.0 * texel_centres(size * steps, size * steps) - 1.0, axis=-1) < 1.0
    covered = inside.reshape(size, steps, size, steps).mean(axis=(1, 3))
    texel_area = (2.0 / size) ** 2
    np.testing.assert_allclose(solid_angle, 4.0 * texel_area * covered, atol=4.0 * texel_area * 3.0 / steps)
    np.testing.assert_allclose(solid_angle, solid_angle[::-1].T, atol=1e-14)


def test_uniform_directions_fill_texels_by_their_solid_angle() -> None:
    size, count = 8, 200_000
    directions = normalize(np.random.default_rng(7).normal(size=(count, 3)))
    column, row = (sphere_map.uv_from_direction(directions) * size).astype(int).T
    hits = np.bincount(row * size + column, minlength=size * size)
    expected = count * sphere_map.texel_solid_angle(size).ravel() / (4.0 * np.pi)
    shown = expected > 0.0
    assert hits[~shown].sum() == 0
    degrees = np.count_nonzero(shown) - 1
    chi_squared = np.sum((hits - expected)[shown] ** 2 / expected[shown])
    assert abs(chi_squared - degrees) < 6.0 * np.sqrt(2.0 * degrees)


def test_beyond_the_edge_lies_the_edge() -> None:
    columns, rows = sphere_map.wrap(np.array([-3, 0, 4, 9]), np.array([2, -1, 7, 3]), 5, 5)
    assert columns.tolist() == [0, 0, 4, 4]
    assert rows.tolist() == [2, 0, 4, 3]


SIZE = 24
COVERAGE = sphere_map.texel_solid_angle(SIZE) / (4.0 * (2.0 / SIZE) ** 2)


def rendered(radiance: np.ndarray) -> np.ndarray:
    return radiance * COVERAGE[..., None]


def test_filling_takes_the_coverage_out() -> None:
    radiance = RNG.random((SIZE, SIZE, 3))
    premultiplied = rendered(radiance)
    before = premultiplied.copy()
    filled = sphere_map.fill_rim(premultiplied, COVERAGE)
    np.testing.assert_array_equal(premultiplied, before)
    assert filled.dtype == np.float32
    seen = COVERAGE > 0.5
    assert np.any(seen & (COVERAGE < 0.99))
    np.testing.assert_allclose(filled[seen], radiance[seen], rtol=1e-6)


def test_outside_lies_what_the_rim_shows() -> None:
    points = 2.0 * texel_centres(SIZE, SIZE) - 1.0
    bearing = points / np.linalg.norm(points, axis=-1, keepdims=True)
    radiance = np.concatenate([bearing, np.ones((SIZE, SIZE, 1))], axis=-1)
    filled = sphere_map.fill_rim(rendered(radiance), COVERAGE)
    # On the way inwards the nearest texel is at most a texel's half diagonal off the way, and it is
    # met before the centre of a texel that is at most a half-covered texel, 1.5 diagonals, inside.
    texel = 2.0 / SIZE
    off_bearing = (0.5 * np.sqrt(2.0) * texel) / (1.0 - 1.5 * np.sqrt(2.0) * texel)
    assert np.abs(filled - radiance).max() < off_bearing
    np.testing.assert_array_equal(filled[..., 2], 1.0)


def test_what_lies_outside_comes_from_close_by() -> None:
    radius = np.linalg.norm(2.0 * texel_centres(SIZE, SIZE) - 1.0, axis=-1)
    filled = sphere_map.fill_rim(rendered(np.repeat(radius[..., None], 3, axis=-1)), COVERAGE)[..., 0]
    # Steps of half a texel end in the first texel that is half covered: its centre is no more than
    # its diagonal and one step inside the rim.
    texel = 2.0 / SIZE
    assert np.all(filled[COVERAGE <= 0.5] > 1.0 - (np.sqrt(2.0) + 0.5) * texel)


def test_slivers_count_as_outside() -> None:
    sliver = (COVERAGE > 0.0) & (COVERAGE <= 0.5)
    assert np.count_nonzero(sliver) > SIZE
    radiance = np.where(sliver[..., None], 100.0, np.ones(3))
    np.testing.assert_allclose(sphere_map.fill_rim(rendered(radiance), COVERAGE), 1.0, rtol=1e-6)


def test_lookups_up_to_the_rim_mix_in_nothing_foreign() -> None:
    filled = sphere_map.fill_rim(rendered(np.full((SIZE, SIZE, 3), 0.7)), COVERAGE)
    np.testing.assert_allclose(bilinear(filled, 0.5 + 0.5 * RIM, sphere_map.wrap), 0.7, rtol=1e-6)


@pytest.mark.parametrize(
    ("radiance", "coverage", "size"),
    [
        (np.zeros((4, 6, 3)), np.ones((4, 6)), "6x4"),
        (np.zeros((4, 4, 3)), np.full((4, 4), 0.5), "4x4"),
    ],
)
def test_what_shows_no_sphere_is_refused(radiance: np.ndarray, coverage: np.ndarray, size: str) -> None:
    with pytest.raises(ShapeError, match=f"square and shows a sphere; this one is {size}"):
        sphere_map.fill_rim(radiance, coverage)
