"""Lamps in a map: where they belong, with all their light."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import RangeError
from rsibr.rsibr_addon.core.light.lamps import LampLight, add_lamps, angular_width, directions_in_cap
from rsibr.rsibr_addon.core.maps import equirect

WIDTH, HEIGHT = 64, 32


def power(radiance: np.ndarray) -> np.ndarray:
    """Integral over the sphere, shape (3,)."""
    return np.einsum("hw,hwc->c", equirect.texel_solid_angle(WIDTH, HEIGHT), radiance)


@pytest.mark.parametrize(
    "direction", [(0.0, 0.0, 1.0), (0.0, 0.0, -1.0), (-1.0, 0.0, 0.0), (0.6, -0.48, 0.64)]
)
def test_a_point_fills_one_texel_with_its_irradiance(direction: tuple[float, float, float]) -> None:
    before = np.full((HEIGHT, WIDTH, 3), 0.5)
    added = add_lamps(before, [LampLight(np.array([direction]), np.array([1.0, 2.0, 0.0]))]) - before
    assert np.count_nonzero(added[..., 0]) == 1
    np.testing.assert_allclose(power(added), (1.0, 2.0, 0.0), rtol=1e-12)
    brightest = np.unravel_index(np.argmax(added[..., 1]), (HEIGHT, WIDTH))
    centre = equirect.direction_from_uv(
        np.array([(brightest[1] + 0.5) / WIDTH, (brightest[0] + 0.5) / HEIGHT])
    )
    # No farther than half a texel's diagonal
    assert np.arccos(centre @ direction) <= np.sqrt(2.0) * 0.5 * np.pi / HEIGHT


def test_lamps_add_up() -> None:
    lamps = [
        LampLight(directions_in_cap((1.0, 0.0, 0.0), a, 50), np.full(3, e)) for a, e in ((0.3, 2), (0, 5))
    ]
    both = add_lamps(np.zeros((HEIGHT, WIDTH, 3)), lamps)
    one_by_one = sum(add_lamps(np.zeros((HEIGHT, WIDTH, 3)), [lamp]) for lamp in lamps)
    np.testing.assert_allclose(both, one_by_one, rtol=1e-12)
    np.testing.assert_allclose(power(both), 7.0, rtol=1e-12)
    assert not np.any(add_lamps(np.zeros((HEIGHT, WIDTH, 3)), []))


@pytest.mark.parametrize("axis", [(0.0, 0.0, 1.0), (0.36, 0.48, -0.8)])
def test_a_cap_is_evenly_covered(axis: tuple[float, float, float]) -> None:
    half_angle, count = 0.7, 4000
    directions = directions_in_cap(axis, half_angle, count)
    np.testing.assert_allclose(np.linalg.norm(directions, axis=-1), 1.0, rtol=1e-12)
    cosine = directions @ axis
    assert cosine.min() >= np.cos(half_angle)
    # Mean cosine of a cap is (1 + cos) / 2, the mean direction is its axis. A sunflower's seeds are some
    # half_angle * sqrt(pi / count) apart, and its rim is off by at most one of them.
    step = half_angle * np.sqrt(np.pi / count)
    np.testing.assert_allclose(
        directions.mean(axis=0), 0.5 * (1 + np.cos(half_angle)) * np.array(axis), atol=step
    )
    within = cosine > np.cos(0.5 * half_angle)
    share = (1.0 - np.cos(0.5 * half_angle)) / (1.0 - np.cos(half_angle))
    assert within.mean() == pytest.approx(share, abs=1.0 / count)


def test_a_large_lamp_is_as_bright_everywhere() -> None:
    half_angle = 0.8
    directions = directions_in_cap((1.0, 0.0, 0.0), half_angle, 200_000)
    added = add_lamps(np.zeros((HEIGHT, WIDTH, 3)), [LampLight(directions, np.ones(3))])
    u, v = (np.arange(WIDTH) + 0.5) / WIDTH, (np.arange(HEIGHT) + 0.5) / HEIGHT
    cosine = equirect.direction_from_uv(np.stack(np.meshgrid(u, v), axis=-1))[..., 0]
    inside = cosine > np.cos(half_angle - np.pi / HEIGHT)
    expected = 1.0 / (2.0 * np.pi * (1.0 - np.cos(half_angle)))
    # A texel of 3e-3 to 1e-2 sr holds some 400 to 1000 directions, of which only those at its edges are
    # uncertain: some 80, by chance up to five times their square root, 45.
    np.testing.assert_allclose(added[inside], expected, rtol=0.1)
    assert not np.any(added[cosine < np.cos(half_angle + np.pi / HEIGHT)])


def test_width() -> None:
    assert angular_width(directions_in_cap((0.0, 1.0, 0.0), 0.0, 9)) == 0.0
    for half_angle in (1e-6, 0.01, 1.0):
        directions = directions_in_cap((0.6, 0.8, 0.0), half_angle, 3000)
        # The outermost seed is half a step within; their mean is off by less.
        assert angular_width(directions) == pytest.approx(2.0 * half_angle, rel=0.02)
    assert angular_width([[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]]) == 2.0 * np.pi


@pytest.mark.parametrize(("half_angle", "count"), [(-0.1, 5), (4.0, 5), (0.1, 0), (np.nan, 5)])
def test_what_is_no_cap_is_refused(half_angle: float, count: int) -> None:
    with pytest.raises(RangeError, match="half-angle from 0 to 180 degrees"):
        directions_in_cap((0.0, 0.0, 1.0), half_angle, count)
