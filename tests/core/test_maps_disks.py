"""Disk maps: angular map, mirror ball, dual paraboloid and orthographic pair, each in its own axes."""

from collections.abc import Callable
from functools import partial

import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import RangeError
from rsibr.rsibr_addon.core.geometry.directions import dot, normalize, reflect
from rsibr.rsibr_addon.core.maps import angular_map, dual_paraboloid, mirror_ball, orthographic, sphere_map

EPS = np.finfo(float).eps
RNG = np.random.default_rng(0)
DIRECTIONS = np.concatenate([normalize(RNG.standard_normal((2000, 3))), np.eye(3), -np.eye(3)])
DISTANCES = [1.001, 1.1, 3.0, 30.0, 1e6, np.inf]


def in_disk(count: int, radius: float = 1.0) -> np.ndarray:
    """Points of a sheet, evenly in the inscribed disk and somewhat inside its rim."""
    r = 0.999 * radius * np.sqrt(RNG.random(count))
    azimuth = 2.0 * np.pi * RNG.random(count)
    return 0.5 + 0.5 * r[:, None] * np.stack([np.cos(azimuth), np.sin(azimuth)], axis=-1)


def seen_in_disk(
    size: int, extent: float, theta_from_radius: Callable[[np.ndarray], np.ndarray]
) -> np.ndarray:
    """Solid angles of the texels of one sheet by the midpoint rule on a fine polar grid."""
    radii, azimuths = 1000, 1024
    rims = theta_from_radius(np.linspace(0.0, 1.0, radii + 1))
    rings = np.abs(np.diff(np.cos(rims))) * 2.0 * np.pi / azimuths
    radius = (np.arange(radii)[:, None] + 0.5) / radii
    azimuth = 2.0 * np.pi * (np.arange(azimuths) + 0.5) / azimuths
    column, row = ((0.5 + 0.5 * radius * f(azimuth) / extent) * size for f in (np.cos, np.sin))
    texel = row.astype(int) * size + column.astype(int)
    weights = np.broadcast_to(rings[:, None], texel.shape)
    return np.bincount(texel.ravel(), weights.ravel(), size * size).reshape(size, size)


def test_angular_map_by_hand() -> None:
    # The radius is the angle from -z over pi: ahead in the middle, the axes half-way, behind on the rim
    anchors = {
        (0.5, 0.5): (0, 0, -1),
        (0.75, 0.5): (1, 0, 0),
        (0.5, 0.75): (0, 1, 0),
        (0.25, 0.5): (-1, 0, 0),
        (1.0, 0.5): (0, 0, 1),
        (0.5, 0.0): (0, 0, 1),
        (0.5 + 1 / 6, 0.5): (np.sin(np.pi / 3), 0, -0.5),
        (1.0, 1.0): (0, 0, 1),
    }
    found = angular_map.direction_from_uv(list(anchors))
    np.testing.assert_allclose(found, list(anchors.values()), atol=4.0 * EPS)


@pytest.mark.parametrize("distance", DISTANCES)
def test_the_mirror_ball_obeys_the_law_of_reflection(distance: float) -> None:
    # Trace the photograph's rays: the camera's ray through a point of the outline's disk hits the ball
    uv = in_disk(500)
    finite = min(distance, 1e9)
    eye = np.array([0.0, 0.0, finite])
    # Where the tangent cone's circle of directions is cut by the plane z = 0: x = r d / sqrt(d^2 - 1)
    on_plane = np.append(2.0 * uv - 1.0, np.zeros((500, 1)), axis=1) * finite / np.sqrt(finite**2 - 1.0)
    ray = normalize(on_plane - eye)
    along = -dot(ray, eye) - np.sqrt(np.maximum(dot(ray, eye) ** 2 - (finite**2 - 1.0), 0.0))
    normal = eye + along[:, None] * ray
    expected = reflect(-ray, normal)
    # The root loses half the digits of (distance)^2 eps: far away the oracle is the weaker of the two
    tolerance = 1e-9 if distance < 100.0 else 1e-3
    if distance < 1e6:
        np.testing.assert_allclose(mirror_ball.direction_from_uv(uv, distance), expected, atol=tolerance)
    else:
        far = 2.0 / distance
        np.testing.assert_allclose(
            mirror_ball.direction_from_uv(uv, distance), sphere_map.direction_from_uv(uv), atol=far + 1e-14
        )


@pytest.mark.parametrize("distance", DISTANCES)
def test_the_mirror_balls_inverse_and_blind_spot(distance: float) -> None:
    blind = mirror_ball.blind_angle(distance)
    assert blind == pytest.approx(np.arcsin(1.0 / distance))
    hidden = -DIRECTIONS[:, 2] > np.cos(blind) - 1e-9
    uv = mirror_ball.uv_from_direction(DIRECTIONS, distance)
    back = mirror_ball.direction_from_uv(uv, distance)
    # Near the outline the angle is a root of the distance from it: half the digits, 1e-8, are left
    np.testing.assert_allclose(back[~hidden], DIRECTIONS[~hidden], atol=1e-7)
    radius = np.linalg.norm(2.0 * uv[hidden] - 1.0, axis=1)
    np.testing.assert_allclose(radius, 1.0, atol=1e-12)


@pytest.mark.parametrize("distance", [1.0, 0.5, -3.0, np.nan])
def test_a_camera_in_the_ball_is_refused(distance: float) -> None:
    with pytest.raises(RangeError, match="is in the ball: step back"):
        mirror_ball.direction_from_uv((0.5, 0.5), distance)


def test_dual_paraboloid_by_hand() -> None:
    uv = np.array([(0.5, 0.5), (1.0, 0.5), (0.5, 1.0), (0.75, 0.5), (1.0, 1.0)])
    # (2 U, -2 V, 1 - U^2 - V^2) / (1 + U^2 + V^2): the last is beyond the rim, on the other hemisphere
    front = np.array([(0, 0, 1), (1, 0, 0), (0, -1, 0), (0.8, 0, 0.6), (2 / 3, -2 / 3, -1 / 3)])
    for sheet, expected in ((0, front), (1, -front)):
        found = dual_paraboloid.direction_from_uv(uv, np.array(sheet))
        np.testing.assert_allclose(found, expected, atol=4.0 * EPS)
    # The same directions with an overscan lie nearer to the middle
    found = dual_paraboloid.direction_from_uv(0.5 + (uv - 0.5) / 1.2, np.array(0), 1.2)
    np.testing.assert_allclose(found, front, atol=4.0 * EPS)


@pytest.mark.parametrize("overscan", [0.999, 0.0, np.inf, np.nan])
def test_an_overscan_that_leaves_directions_out_is_refused(overscan: float) -> None:
    with pytest.raises(RangeError, match="give 1 or more"):
        dual_paraboloid.uv_from_direction(DIRECTIONS, overscan)


def test_orthographic_pair_as_the_paper_has_it() -> None:
    # [Miller1984] section 4.2: u = x, v = y, one array for z >= 0 and one for z < 0
    uv, sheet = orthographic.uv_from_direction(DIRECTIONS)
    np.testing.assert_array_equal(uv, 0.5 + 0.5 * DIRECTIONS[:, :2])
    np.testing.assert_array_equal(sheet, DIRECTIONS[:, 2] < 0.0)


@pytest.mark.parametrize("module", [angular_map, sphere_map])
def test_inverse_of_a_single_disk(module) -> None:
    uv = in_disk(1000)
    np.testing.assert_allclose(module.uv_from_direction(module.direction_from_uv(uv)), uv, atol=1e-12)
    # On the sphere map's rim, the singularity, half of the digits are left
    atol = 8.0 * EPS if module is angular_map else 4.0 * np.sqrt(EPS)
    np.testing.assert_allclose(
        module.direction_from_uv(module.uv_from_direction(DIRECTIONS)), DIRECTIONS, atol=atol
    )


@pytest.mark.parametrize(
    ("to_direction", "to_uv", "rim"),
    [
        (dual_paraboloid.direction_from_uv, dual_paraboloid.uv_from_direction, 1.0),
        (
            partial(dual_paraboloid.direction_from_uv, overscan=1.2),
            partial(dual_paraboloid.uv_from_direction, overscan=1.2),
            1.0 / 1.2,
        ),
        (orthographic.direction_from_uv, orthographic.uv_from_direction, 1.0),
    ],
    ids=["paraboloid", "overscan", "orthographic"],
)
def test_inverse_of_a_pair(to_direction, to_uv, rim: float) -> None:
    uv, sheet = to_uv(DIRECTIONS)
    # z of an orthographic map is a root: half of the digits at the rim
    np.testing.assert_allclose(to_direction(uv, sheet), DIRECTIONS, atol=4.0 * np.sqrt(EPS))
    uv, sheet = in_disk(1000, rim), RNG.integers(0, 2, 1000)
    found, on = to_uv(to_direction(uv, sheet))
    np.testing.assert_array_equal(on, sheet)
    np.testing.assert_allclose(found, uv, atol=8.0 * EPS)
    # What a pair shows is continuous across the rim: both sheets show its directions
    around = np.linspace(0.0, 2.0 * np.pi, 33)
    on_rim = 0.5 + 0.5 * rim * np.stack([np.cos(around), np.sin(around)], axis=-1)
    shown = [to_direction(on_rim, np.array(sheet)) for sheet in (0, 1)]
    assert np.abs(np.stack(shown)[..., 2]).max() < 4.0 * np.sqrt(EPS)


@pytest.mark.parametrize(
    ("solid_angle", "extent", "theta"),
    [
        (angular_map.texel_solid_angle, 1.0, lambda r: np.pi * r),
        (lambda n: dual_paraboloid.texel_solid_angle(n)[0], 1.0, lambda r: 2.0 * np.arctan(r)),
        (lambda n: dual_paraboloid.texel_solid_angle(n, 1.3)[1], 1.3, lambda r: 2.0 * np.arctan(r)),
        (lambda n: orthographic.texel_solid_angle(n)[0], 1.0, np.arcsin),
        (
            lambda n: mirror_ball.texel_solid_angle(n, 2.0),
            1.0,
            # The line of sight s and incidence i at radius r: tan s = r / sqrt(3), sin i = 2 sin s
            lambda r: (
                2.0 * np.arcsin(np.minimum(2.0 * np.sin(np.arctan(r / np.sqrt(3.0))), 1.0))
                - np.arctan(r / np.sqrt(3.0))
            ),
        ),
    ],
    ids=["angular", "paraboloid", "overscan", "orthographic", "mirror ball"],
)
@pytest.mark.parametrize("size", [1, 2, 7, 16])
def test_solid_angles_of_texels(solid_angle, extent: float, theta, size: int) -> None:
    expected = seen_in_disk(size, extent, theta)
    found = solid_angle(size)
    assert found.sum() == pytest.approx(2.0 * np.pi * (1.0 - np.cos(theta(np.ones(1))[0])), rel=1e-14)
    # A cell of the oracle's grid, at most 2e-5 sr, is in one texel or the next. A texel's outline crosses
    # up to 4000 cells; the parts that are counted wrongly are random, so their sum is within 20 cells
    np.testing.assert_allclose(found, expected, rtol=0, atol=4e-4)
    np.testing.assert_allclose(found, found[::-1], rtol=1e-12)
    np.testing.assert_allclose(found, found.T, rtol=1e-12)
    assert found.min() >= 0.0


def test_solid_angles_agree_with_the_sphere_maps() -> None:
    # A mirror ball seen from afar is a sphere map, whose texels have a closed form of their own
    np.testing.assert_allclose(
        mirror_ball.texel_solid_angle(31, np.inf), sphere_map.texel_solid_angle(31), rtol=1e-11, atol=1e-15
    )


def test_texels_outside_the_disk_count_nothing() -> None:
    solid_angle = dual_paraboloid.texel_solid_angle(24, 1.5)
    centred = np.abs(np.linspace(-1.5, 1.5, 25))
    nearest = np.minimum(centred[:-1], centred[1:])
    outside = np.hypot(nearest, nearest[:, None]) >= 1.0
    np.testing.assert_array_equal(solid_angle == 0.0, np.stack([outside, outside]))


def test_pairs_wrap_within_their_sheet() -> None:
    wrapped = dual_paraboloid.wrap(np.array([-2, 4, 9]), np.array([8, -1, 3]), np.array([0, 1, 1]), 8, 8)
    np.testing.assert_array_equal(wrapped, [(0, 4, 7), (7, 0, 3), (0, 1, 1)])
