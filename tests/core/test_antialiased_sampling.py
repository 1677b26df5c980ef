"""Lookups spread over what a pixel reflects: none too few, none too many, and what they gain."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.antialiased.footprint import (
    footprint_or_point,
    footprint_sides,
    parallelogram,
)
from rsibr.rsibr_addon.core.antialiased.sampling import MOST, sample_counts, samples
from rsibr.rsibr_addon.core.geometry.directions import normalize
from rsibr.rsibr_addon.core.kinds.lobe_stack.stack import LAYOUTS
from rsibr.rsibr_addon.core.maps import cube_map, sphere_map
from rsibr.rsibr_addon.core.maps.representation import representation
from rsibr.tests.lobe_stacks import random_stack

RNG = np.random.default_rng(71)
MIDDLE = normalize(RNG.normal(size=(300, 3)))
ACROSS, UP = (10.0 ** RNG.uniform(-3.0, 0.5, (300, 1)) * RNG.normal(size=(300, 3)) for _ in range(2))


def test_a_parallelogram_has_its_sides() -> None:
    across, up = footprint_sides(parallelogram(MIDDLE, ACROSS, UP))
    np.testing.assert_allclose(across, ACROSS, atol=1e-14)
    np.testing.assert_allclose(up, UP, atol=1e-14)


def test_a_point_has_no_sides() -> None:
    sides = footprint_sides(footprint_or_point(None, MIDDLE))
    np.testing.assert_array_equal(sides, 0.0)
    assert np.all(sample_counts(*sides, 0.1) == 1)


def test_lookups_are_a_texel_apart_and_no_nearer_than_they_need() -> None:
    counts = sample_counts(ACROSS, UP, 0.3)
    for count, side in zip(np.moveaxis(counts, -1, 0), (ACROSS, UP), strict=True):
        length = np.linalg.norm(side, axis=-1)
        assert np.all((length / count <= 0.3) | (count == MOST))
        assert np.all((count == 1) | (length > 0.3 * (count - 1)))
    assert {1, MOST} <= set(counts.ravel())


def test_lookups_fill_the_pixel_evenly() -> None:
    counts = sample_counts(ACROSS, UP, 0.3)
    total, mean, spread = np.zeros(300), np.zeros((300, 3)), np.zeros(300)
    for chosen, direction, weight in samples(MIDDLE, 1e-4 * ACROSS, 1e-4 * UP, counts):
        total[chosen] += weight[:, 0]
        mean[chosen] += weight * direction
        spread[chosen] += weight[:, 0] * np.sum((direction - MIDDLE[chosen]) ** 2, axis=-1)
    np.testing.assert_allclose(total, 1.0)
    # Small enough for the sphere to be flat: within the square of what a pixel reflects.
    np.testing.assert_allclose(mean, MIDDLE, atol=1e-6)
    # The middles of n equal parts have the variance (1 - 1/n^2) / 12 along a side; only what lies along the
    # sphere counts.
    across, up = (side - np.sum(side * MIDDLE, axis=-1, keepdims=True) * MIDDLE for side in (ACROSS, UP))
    variance = (1.0 - 1.0 / counts**2) / 12.0
    expected = variance[:, 0] * np.sum(across**2, axis=-1) + variance[:, 1] * np.sum(up**2, axis=-1)
    np.testing.assert_allclose(spread, 1e-8 * expected, rtol=2e-3, atol=1e-14)


def test_texels_of_a_cube_are_as_far_apart_as_their_solid_angles_say() -> None:
    directions = representation("cube_map").texel_directions(64)
    # A texel of 1/32 changes its solid angle by less than a thousandth within itself.
    expected = np.sqrt(cube_map.texel_solid_angle(64))
    np.testing.assert_allclose(cube_map.texel_angle(directions, 64), expected, rtol=1e-3)


@pytest.mark.parametrize("layout", LAYOUTS)
def test_texels_of_a_stack_are_as_far_apart_as_their_solid_angles_say(layout: str) -> None:
    stack = random_stack(layout, 64)
    own = stack.representation
    expected = np.sqrt(own.texel_solid_angle(64))
    # Texels that the rim of a hemisphere cuts count within it alone.
    whole = expected > 0.99 * 2.0 / 64
    found = stack.texel_angle(own.texel_directions(64))
    np.testing.assert_allclose(found[whole], expected[whole], rtol=0.02)
    np.testing.assert_allclose(np.median(found[whole] / expected[whole]), 1.0, rtol=1e-3)


def test_texels_of_a_sphere_map_are_equally_far_apart() -> None:
    assert sphere_map.texel_angle(64) ** 2 == pytest.approx(sphere_map.texel_solid_angle(64)[32, 32])


@pytest.mark.parametrize("shape", [(), (2, 3)])
def test_pictures_of_any_shape(shape: tuple[int, ...]) -> None:
    middle = np.broadcast_to((0.0, 0.0, 1.0), (*shape, 3))
    counts = sample_counts(0.5 * middle, middle, np.full(shape, 0.2))
    assert counts.shape == (*shape, 2)
    for chosen, direction, _ in samples(middle, 0.5 * middle, middle, counts):
        assert chosen.shape == shape
        np.testing.assert_allclose(direction, np.broadcast_to((0.0, 0.0, 1.0), direction.shape))
