"""Brackets: the camera's curve, its movement, and the merge, against a scene in closed form."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import RangeError
from rsibr.rsibr_addon.core.light.exposure.merge import certainty, merge_bracket
from rsibr.rsibr_addon.core.light.exposure.motion import Motion, looked_up, motion_between, pixel_points
from rsibr.rsibr_addon.core.light.exposure.response import linear_response, recover_response, srgb_response
from rsibr.rsibr_addon.core.light.transfer_curve import linear_from_srgb
from rsibr.tests.synthetic_camera import exposure_of, photograph, scene

POINTS = pixel_points(320, 240)
TIMES = (1 / 64, 1 / 16, 1 / 4, 1.0, 4.0)


def ratio_error(found: np.ndarray, expected: np.ndarray) -> np.ndarray:
    """Relative error up to one factor."""
    ratio = np.log(found / expected)
    return np.abs(ratio - np.median(ratio))


def test_the_cameras_curve_is_recovered() -> None:
    photographs = np.stack([photograph(POINTS[::3, ::3], time) for time in TIMES]).reshape(5, -1, 3)
    weights = np.clip(2.0 * np.minimum(photographs, 1.0 - photographs), 0.0, 1.0)
    response = recover_response(photographs, weights, TIMES)
    levels = np.arange(20, 250)
    expected = np.log(exposure_of(levels / 255.0))
    found = response.log_exposure[levels] - expected[:, None]
    # A ripple that comes again at each factor of four in exposure shows in no pair of photographs: it is
    # held down by smoothness alone. Rounding at level 20 is 5 % of exposure, but averages out
    np.testing.assert_allclose(found - found[108], 0.0, atol=0.03)
    np.testing.assert_allclose(response.log_exposure[128], np.log(linear_from_srgb(128 / 255)), atol=1e-3)
    assert np.all(np.diff(response.log_exposure, axis=0) >= 0.0)


def test_known_curves() -> None:
    encoded = np.array([[0.25, 0.5, 1.0]])
    np.testing.assert_allclose(np.exp(linear_response().logarithm(encoded)), encoded, rtol=1e-12)
    # Between levels exposure is interpolated: its curvature, 1.4 x^-0.8 / x^2, times (1/255)^2 / 8
    expected = linear_from_srgb(encoded)
    np.testing.assert_allclose(np.exp(srgb_response().logarithm(encoded)), expected, rtol=1e-4)
    assert np.all(np.isfinite(srgb_response().log_exposure))


@pytest.mark.parametrize(
    "motion",
    [
        Motion(),
        Motion(1.0, 7.3 - 4.6j),
        Motion(1.0, -61.0 + 33.0j),
        Motion(np.exp(0.012j), 2.4 + 5.5j),
        Motion(1.015 * np.exp(-0.02j), -8.7 + 1.2j),
    ],
)
def test_movements_are_found_whatever_the_exposure(motion: Motion) -> None:
    # A point p of the first is at motion.of(p) in the second, which there sees the same thing
    first = photograph(POINTS, 0.25)[..., 1]
    second = photograph(motion.inverse().of(POINTS), 1.0)[..., 1]
    found = motion_between(first, second)
    error = np.abs(found.of(POINTS) - motion.of(POINTS))
    # A tile tells its shift to a tenth of a pixel or two; the corners lie outside of the tiles' middles
    assert error.max() < 0.25


def test_movements_compose() -> None:
    first, second = Motion(np.exp(0.3j), 2.0 + 1.0j), Motion(1.1, -3.0j)
    points = pixel_points(4, 3)
    np.testing.assert_allclose(second.after(first).of(points), second.of(first.of(points)))
    np.testing.assert_allclose(first.inverse().of(first.of(points)), points, atol=1e-12)
    assert Motion(1.0, 3.0 + 4.0j).most(10, 10) == pytest.approx(5.0)
    # A turn by 90 degrees takes a corner to the next one
    assert Motion(1j).most(10, 6) == pytest.approx(np.sqrt(2.0) * np.hypot(5, 3))


def test_pixels_are_looked_up_at_their_points() -> None:
    image = np.arange(12.0).reshape(3, 4, 1)
    np.testing.assert_allclose(looked_up(image, pixel_points(4, 3)), image)
    shifted = looked_up(image, pixel_points(4, 3) + 1.0)
    np.testing.assert_allclose(shifted[:, :3], image[:, 1:])
    # Beyond the edge, the edge
    np.testing.assert_allclose(shifted[:, 3], image[:, 3])


def test_what_lies_beside_white_is_uncertain() -> None:
    encoded = np.full((5, 5, 3), 0.5)
    encoded[2, 2, 0] = 1.0
    told = certainty(encoded) > 0.9
    expected = np.ones((5, 5, 3), dtype=bool)
    expected[1:4, 1:4, 0] = False
    np.testing.assert_array_equal(told, expected)
    assert np.all(certainty(encoded)[1:4, 1:4, 0] == 0.0)
    assert np.all(certainty(np.full((3, 3, 3), 2 / 255)) == 0.0)


@pytest.mark.slow
@pytest.mark.parametrize("hand_held", [False, True])
def test_a_merged_bracket_is_the_scene(hand_held: bool) -> None:
    movements = [Motion()] * 5
    if hand_held:
        movements = [
            Motion(1.0, 5.2 - 3.1j),
            Motion(np.exp(0.01j), -2.2j),
            Motion(),
            Motion(np.exp(-0.008j), 4.0 + 1.6j),
            Motion(1.005, -3.3 + 2.0j),
        ]
    photographs = [
        photograph(movement.inverse().of(POINTS), time, noise=0.01)
        for movement, time in zip(movements, TIMES, strict=True)
    ]
    merged = merge_bracket(photographs, TIMES)
    reference = next(i for i, motion in enumerate(merged.motions) if motion == Motion())
    expected = scene(movements[reference].inverse().of(POINTS))
    inner = (slice(12, -12), slice(12, -12))
    error = ratio_error(merged.radiance, expected)[inner]
    # The recovered curve is right to 1 or 2 %. A tenth of a pixel's movement costs a tenth of the slope of
    # ln L, whose root mean square is 0.3 a pixel
    assert np.median(error) < 0.02
    # Noise is 4 % of the darkest exposure that counts, of 0.07
    assert np.quantile(error, 0.99) < (0.12 if hand_held else 0.08)


def test_a_known_curve_gives_radiance_itself() -> None:
    radiance = np.geomspace(0.01, 10.0, 300).reshape(20, 15)[..., None] * np.ones(3)
    photographs = [np.clip(radiance * time, 0.0, 1.0) for time in (0.05, 0.4, 3.2)]
    merged = merge_bracket(photographs, (0.05, 0.4, 3.2), linear_response(), align=False)
    np.testing.assert_allclose(merged.radiance, radiance, rtol=1e-6)  # float32
    assert merged.saturated == merged.black == 0.0


def test_what_no_photograph_tells_is_counted() -> None:
    radiance = np.full((16, 16, 3), 0.5)
    radiance[2:6, 2:6] = 100.0
    radiance[12, 12] = 0.0
    merged = merge_bracket(
        [radiance.clip(0, 1), (0.5 * radiance).clip(0, 1)][::-1], (0.5, 1.0), linear_response()
    )
    assert merged.saturated == pytest.approx(16 / 256)
    assert merged.black == pytest.approx(1 / 256)
    assert merged.radiance[4, 4, 0] == pytest.approx(2.0, rel=1e-3)
    # Beside the lamp no photograph can be trusted; there, the longest one counts
    assert merged.radiance[2, 6, 0] == pytest.approx(0.5, rel=1e-3)
    assert np.all(merged.radiance[12, 12] < 0.01)


def test_a_longer_exposure_that_is_darker_does_not_count() -> None:
    radiance = np.geomspace(0.05, 3.0, 600).reshape(20, 30)[..., None] * np.ones(3)
    photographs = [np.clip(radiance * time, 0.0, 1.0) for time in (0.25, 1.0, 4.0)]
    # A camera that clips long exposures to grey, where the shorter ones are still right
    photographs[2][photographs[2] >= 1.0] = 0.6
    merged = merge_bracket(photographs, (0.25, 1.0, 4.0), linear_response(), align=False)
    # Up to 0.6 / 0.25 the shorter ones are darker than that, and the grey cannot be told from light
    told = radiance > 2.5
    np.testing.assert_allclose(merged.radiance[told], radiance[told], rtol=1e-5)


def test_lamps_that_are_white_throughout_get_no_colour() -> None:
    scene_light = np.geomspace(0.02, 2.0, 900).reshape(30, 30)[..., None] * np.array([1.0, 0.8, 0.6])
    scene_light[10:16, 10:16] = 500.0
    photographs = [np.clip(scene_light * time, 0.0, 1.0) ** [0.4, 0.5, 0.6] for time in (0.2, 0.7, 2.0)]
    lamp = merge_bracket(photographs, (0.2, 0.7, 2.0), align=False).radiance[12, 12]
    np.testing.assert_allclose(lamp, lamp[0], rtol=1e-6)


def test_bad_brackets_are_refused() -> None:
    grey, white = np.full((8, 8, 3), 0.5), np.ones((8, 8, 3))
    with pytest.raises(RangeError, match="One photograph is no bracket: give two or more"):
        merge_bracket([grey], [1.0])
    with pytest.raises(RangeError, match="same exposure: give some that differ"):
        merge_bracket([grey, grey], [1.0, 1.0])
    for times in ((2.0, 1.0), (0.0, 1.0), (1.0, np.inf), (-1.0, 1.0)):
        with pytest.raises(RangeError, match="must be positive, and the photographs in their order"):
            merge_bracket([grey, grey], times)
    for pair in ((white, white), (0.0 * white, 0.0 * white), (0.0 * white, white)):
        with pytest.raises(RangeError, match="are black or white: take exposures neither too long"):
            merge_bracket(pair, [1.0, 2.0], linear_response())
    with pytest.raises(RangeError, match="No part of the photographs is between black and white in two"):
        merge_bracket([grey, white], [1.0, 2.0], align=False)
