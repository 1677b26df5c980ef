"""Tables averaged over footprints, three ways: against brute force, closed forms and each other."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.antialiased.footprint import footprint_box, pixel_footprints
from rsibr.rsibr_addon.core.antialiased.quadrilateral import quadrilateral_mean
from rsibr.rsibr_addon.core.antialiased.recursive import recursive_mean, table_entry
from rsibr.rsibr_addon.core.antialiased.summed_area import box_mean, summed_area_table
from rsibr.rsibr_addon.core.errors import RangeError
from rsibr.rsibr_addon.core.geometry.directions import normalize
from rsibr.rsibr_addon.core.geometry.geodesic import spherical_excess
from rsibr.rsibr_addon.core.maps import equirect
from rsibr.rsibr_addon.core.resample import bilinear

HEIGHT, WIDTH = 16, 32
TABLE = np.random.default_rng(30).random((HEIGHT, WIDTH, 3))


def footprints(count: int, size: float, seed: int = 31) -> np.ndarray:
    """Skewed quadrilaterals of random shape; the first ones hold the poles, the seam and a pole's border."""
    rng = np.random.default_rng(seed)
    middle = rng.normal(size=(count, 3))
    middle[:4] = [(0.1 * size, 0.2 * size, 1.0), (0.1 * size, -size / 9, -1.0), (-1, 0, 0.3), (size, 0, 1)]
    middle = normalize(middle)
    across = normalize(np.cross(middle, rng.normal(size=(count, 3))))
    up = np.cross(middle, across) + 0.3 * across
    across, up = (rng.uniform(0.3, 1.0, (count, 1)) * size * side for side in (across, up))
    corners = [middle + p * across + q * up for p, q in ((-1, -1), (1, -1), (1.2, 1), (-1, 1))]
    return normalize(np.stack(corners, axis=1))


def rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(values**2)))


def halves_by_brute_force(table: np.ndarray, corners: np.ndarray, grid: int = 250) -> np.ndarray:
    """Mean of the means of two spherical triangles, by many points in each."""
    s, t = np.meshgrid(*[(np.arange(grid) + 0.5) / grid] * 2)
    s, t = np.where(s + t > 1.0, 1.0 - s, s).reshape(-1, 1), np.where(s + t > 1.0, 1.0 - t, t).reshape(-1, 1)
    means = []
    for a, b, c in (corners[[0, 1, 2]], corners[[0, 2, 3]]):
        points = a + s * (b - a) + t * (c - a)
        # Solid angle of a piece of the flat triangle: its distance from the plane is the same for all.
        weights = np.linalg.norm(points, axis=1) ** -3.0
        columns, rows = table_entry(table, points)
        means.append(np.average(table[rows, columns], axis=0, weights=weights))
    return np.mean(means, axis=0)


@pytest.mark.parametrize("size", [1e-3, 0.1, 0.6])
def test_a_constant_table_stays_constant(size: float) -> None:
    corners = footprints(300, size)
    ones = np.ones((HEIGHT, WIDTH, 1))
    np.testing.assert_allclose(recursive_mean(ones, corners), 1.0, atol=1e-12)
    # A triangle's area is right to 1e-17 of some 1e-7 for the smallest.
    np.testing.assert_allclose(quadrilateral_mean(ones, corners), 1.0, atol=1e-9)
    boxes = footprint_box(corners, WIDTH, HEIGHT)
    np.testing.assert_allclose(box_mean(summed_area_table(ones), boxes), 1.0, atol=1e-12)


@pytest.mark.parametrize("size", [0.02, 0.1, 0.6])
def test_a_quadrilaterals_mean_is_that_of_many_points(size: float) -> None:
    corners = footprints(12, size)
    brute = [halves_by_brute_force(TABLE, quad) for quad in corners]
    # The points' own error: a line between texels is off by up to 1/250 of the quadrilateral, both ways.
    np.testing.assert_allclose(quadrilateral_mean(TABLE, corners), brute, atol=1e-3)


def test_a_lamp_within_half_a_quadrilateral_counts_by_its_solid_angle() -> None:
    lamp = np.zeros((64, 128, 1))
    lamp[40, 70] = 1e4
    texel = equirect.direction_from_uv(((70.5) / 128, 40.5 / 64))
    a, b, c, d = corners = normalize(
        texel + [(0.1, 0.9, 0.2), (0, -0.9, -0.3), (0.1, -0.5, 0.4), (0, 0.5, 0.9)]
    )
    halves = abs(spherical_excess(a, b, c)), abs(spherical_excess(a, c, d))
    expected = 0.5 * 1e4 * equirect.texel_solid_angle(128, 64)[40, 70] / np.array(halves)
    found = quadrilateral_mean(lamp, corners)[0]
    assert np.min(np.abs(found / expected - 1.0)) < 1e-12


def test_a_quadrilaterals_mean_knows_no_seam_no_sense_and_no_first_corner() -> None:
    corners = footprints(200, 0.2)
    expected = quadrilateral_mean(TABLE, corners)
    turn = 2.0 * np.pi * 5.0 / WIDTH
    rotation = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
    turned = quadrilateral_mean(np.roll(TABLE, -5, axis=1), corners @ rotation.T)
    np.testing.assert_allclose(turned, expected, atol=1e-11)
    other_diagonal = quadrilateral_mean(TABLE, corners[:, [2, 3, 0, 1]])
    np.testing.assert_allclose(other_diagonal, expected, atol=1e-11)
    flipped = quadrilateral_mean(TABLE, corners[:, [0, 3, 2, 1]])
    np.testing.assert_allclose(flipped, expected, atol=1e-11)


def test_a_footprint_without_area_is_averaged_along_its_line() -> None:
    ends = footprints(20, 0.3)[:, :2]
    lines = ends[:, [0, 1, 1, 0]]
    np.testing.assert_array_equal(quadrilateral_mean(TABLE, lines), recursive_mean(TABLE, lines))
    s = (np.arange(4000) + 0.5) / 4000
    points = normalize(ends[:, :1] + s[:, None] * (ends[:, 1:] - ends[:, :1]))
    columns, rows = table_entry(TABLE, points)
    # A line crosses some four texels, each counted to half a texel: a quarter of their spread, .29.
    assert rms(recursive_mean(TABLE, lines) - TABLE[rows, columns].mean(axis=1)) < 0.25 * 0.29


def test_recursion_comes_near_the_quadrilateral() -> None:
    corners = footprints(100, 0.3)
    # Pixel's area against solid angle, and some ten texels along the border known to half a texel, of which
    # the spread is .29: 0.29 * 0.5 * sqrt(10) / 20.
    assert rms(recursive_mean(TABLE, corners) - quadrilateral_mean(TABLE, corners)) < 0.025


def test_footprints_of_pixels_share_their_corners() -> None:
    grid = np.random.default_rng(32).random((4, 5, 3))
    corners = pixel_footprints(grid)
    assert corners.shape == (3, 4, 4, 3)
    np.testing.assert_array_equal(corners[1, 2, :, 0], grid[[1, 1, 2, 2], [2, 3, 3, 2], 0])


def test_boxes_hold_their_corners_and_a_texel() -> None:
    corners = footprints(2000, 0.3)
    low_u, low_v, high_u, high_v = footprint_box(corners, WIDTH, HEIGHT).T
    uv = equirect.uv_from_direction(corners)
    u = uv[..., 0] + (uv[..., 0] < low_u[:, None] - 1e-12)
    assert np.all((low_u >= 0.0) & (low_u < 1.0) & (high_u <= low_u + 1.0 + 1e-12))
    assert np.all((u <= high_u[:, None] + 1e-12) & (uv[..., 1] >= low_v[:, None] - 1e-12))
    assert np.all(uv[..., 1] <= high_v[:, None] + 1e-12)
    assert np.all((low_v >= 0.0) & (high_v <= 1.0))
    assert np.all(high_u - low_u >= 1.0 / WIDTH - 1e-12)
    np.testing.assert_array_equal((low_u[:2], high_u[:2]), ((0.0, 0.0), (1.0, 1.0)))
    np.testing.assert_array_equal((high_v[0], low_v[1]), (1.0, 0.0))


def test_a_box_of_a_texel_interpolates() -> None:
    uv = np.random.default_rng(33).random((500, 2)) * (1.0, 1.0 - 1.0 / HEIGHT) + (0.0, 0.5 / HEIGHT)
    points = equirect.direction_from_uv(uv)
    box = footprint_box(np.repeat(points[:, None], 4, axis=1), WIDTH, HEIGHT)
    columns = np.broadcast_to(TABLE[:1], TABLE.shape)  # rows have weights of their own
    expected = bilinear(columns, uv, equirect.wrap)
    np.testing.assert_allclose(box_mean(summed_area_table(columns), box), expected, atol=1e-12)


def mean_by_hand(table: np.ndarray, box: np.ndarray) -> np.ndarray:
    """Every texel of two turns by the part of it that lies in the box."""
    height, width = table.shape[:2]

    def part(low: float, high: float, count: int) -> np.ndarray:
        texel = np.arange(count)
        return np.clip(np.minimum(high, texel + 1.0) - np.maximum(low, texel), 0.0, None)

    columns = part(box[0] * width, box[2] * width, 2 * width).reshape(2, width).sum(axis=0)
    rows = part(box[1] * height, box[3] * height, height)
    weights = rows[:, None] * columns * equirect.texel_solid_angle(width, height)
    return np.einsum("ji,jic->c", weights, table) / weights.sum()


def test_a_boxs_mean_is_its_texels() -> None:
    rng = np.random.default_rng(34)
    low = rng.random((300, 2))
    high = low + (1.0, 0.0) * 10.0 ** rng.uniform(-3.0, 0.0, (300, 2))
    high[:, 1] = low[:, 1] + (1.0 - low[:, 1]) * rng.random(300)
    boxes = np.concatenate([low, high], axis=1)
    boxes[0], boxes[1], boxes[2] = (0, 0, 1, 1), (0.25, 0.5, 1.25, 1.0), (0.25, 0.5, 0.25 + 1 / WIDTH, 0.5625)
    expected = [mean_by_hand(TABLE, box) for box in boxes]
    np.testing.assert_allclose(box_mean(summed_area_table(TABLE), boxes), expected, rtol=1e-11)


def test_a_sun_costs_its_neighbours_nothing() -> None:
    height, width = 512, 1024
    table = (10.0 ** np.random.default_rng(35).uniform(-3.0, 0.0, (height, width, 1))).astype(np.float32)
    table[300:303, 500:503] = 1e5
    summed = summed_area_table(table)
    rows, columns = np.array([303, 304, 299, 511, 0]), np.array([501, 503, 503, 501, 501])
    box = np.stack([columns / width, rows / height, (columns + 1) / width, (rows + 1) / height], axis=-1)
    # The digits of single precision: the table has no more.
    np.testing.assert_allclose(box_mean(summed, box), table[rows, columns], rtol=2.0**-24)


@pytest.mark.parametrize(
    "box",
    [
        (0.5, 0.5, 0.5, 0.6),
        (0.5, 0.5, 0.4, 0.6),
        (0.1, 0.1, 1.2, 0.2),
        (0.1, 0.5, 0.2, 1.1),
        (0.1, np.nan, 1, 1),
    ],
)
def test_a_box_must_be_one(box: tuple[float, ...]) -> None:
    with pytest.raises(RangeError, match="must have an area and lie within the table"):
        box_mean(summed_area_table(TABLE), box)


@pytest.mark.parametrize("value", [-1.0, np.nan, np.inf])
def test_what_cannot_be_summed_is_refused(value: float) -> None:
    table = TABLE.copy()
    table[3, 4, 1] = value
    with pytest.raises(RangeError, match="negative, infinite or NaN values: repair it"):
        summed_area_table(table)


def test_a_black_channel_stays_black() -> None:
    table = TABLE * (1.0, 0.0, 1.0)
    assert box_mean(summed_area_table(table), (0.1, 0.2, 0.3, 0.4))[1] == 0.0
