"""Photographs of a mirrored ball: its outline, its unwrapping, and two sides put together."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import RangeError
from rsibr.rsibr_addon.core.light.ball_circle import Circle, find_circle
from rsibr.rsibr_addon.core.light.ball_photograph import (
    BallSide,
    cut_ball,
    distance_from_view,
    environment_from_balls,
)
from rsibr.rsibr_addon.core.maps.representation import representation
from rsibr.tests.synthetic_ball import ball_photograph, surroundings

RNG = np.random.default_rng(0)
NOTHING = np.zeros((2, 2, 3))
EQUIRECT = representation("equirect")
EXPECTED = surroundings(EQUIRECT.texel_directions(128)[0])
SOLID_ANGLE = EQUIRECT.texel_solid_angle(128)[0]


def side_seen(turn: float, distance: float, elevation: float = 0.0, camera: float = 0.0) -> BallSide:
    side = BallSide(NOTHING, turn, elevation, distance)
    circle = Circle(130.0, 128.0, 120.0)
    photograph = ball_photograph(side, circle, 260, 250, camera)
    return BallSide(cut_ball(photograph, circle, 240) / 0.8, turn, elevation, distance)


def error_quantiles(radiance: np.ndarray, *shares: float) -> list[float]:
    """Relative errors that so many shares of the sphere stay below."""
    error = np.abs(radiance / EXPECTED - 1.0).max(axis=-1).ravel()
    order = np.argsort(error)
    covered = np.cumsum(SOLID_ANGLE.ravel()[order]) / SOLID_ANGLE.sum()
    return [float(error[order][np.searchsorted(covered, share)]) for share in shares]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("circle", "width", "height"),
    [
        (Circle(200.0, 150.0, 130.0), 400, 300),
        (Circle(171.3, 160.8, 97.6), 360, 300),
        (Circle(150.4, 142.0, 149.0), 300, 290),
    ],
)
def test_a_balls_outline_is_found(circle: Circle, width: int, height: int) -> None:
    photograph = ball_photograph(BallSide(NOTHING, distance=12.0), circle, width, height)
    photograph += RNG.normal(0.0, 0.01, photograph.shape)
    found, score = find_circle(np.clip(photograph, 0.0, 1.0))
    # Gradients are differences of neighbours, looked up at whole pixels
    error = np.array([found.x - circle.x, found.y - circle.y, found.radius - circle.radius])
    assert np.abs(error).max() < 1.0
    assert 0.32 < score <= 1.0


@pytest.mark.slow
def test_large_photographs_are_looked_at_smaller() -> None:
    circle = Circle(1063.0, 811.0, 590.0)
    found, _ = find_circle(ball_photograph(BallSide(NOTHING, distance=12.0), circle, 2112, 1500))
    error = np.array([found.x - circle.x, found.y - circle.y, found.radius - circle.radius])
    # A pixel of the picture half as large
    assert np.abs(error).max() < 2.0


@pytest.mark.slow
def test_no_ball_is_found_where_there_is_none() -> None:
    noise = RNG.random((96, 128, 3))
    ramp = np.linspace(0.0, 1.0, 128)[:, None] * np.ones((96, 128, 3))
    stripes = np.repeat(np.tile([0.0, 1.0], 16), 4)[:, None] * np.ones((96, 128, 3))
    for picture in (noise, stripes, 0.3 * ramp + 0.2):
        with pytest.raises(RangeError, match="No ball was found: let it fill most"):
            find_circle(picture)


def test_a_circle_has_a_radius() -> None:
    for numbers in ((1.0, 2.0, 0.0), (np.nan, 2.0, 3.0), (1.0, 2.0, np.inf)):
        with pytest.raises(RangeError, match="a radius above 0"):
            Circle(*numbers)


def test_a_square_is_cut_around_the_ball() -> None:
    y, x = np.mgrid[:50, :60] + 0.5
    photograph = np.stack([x, y, x + y], axis=-1)
    square = cut_ball(photograph, Circle(31.0, 24.0, 10.0), 8)
    # Linear, so that bilinear lookups are exact; the square is 20 wide, its pixels 2.5
    np.testing.assert_allclose(square[0, :, 0], 21.0 + 2.5 * (np.arange(8) + 0.5))
    np.testing.assert_allclose(square[:, 0, 1], 14.0 + 2.5 * (np.arange(8) + 0.5))


@pytest.mark.parametrize("distance", [3.0, 10.0, 400.0])
def test_distance_by_how_large_the_ball_is(distance: float) -> None:
    field_of_view = np.radians(40.0)
    focal_length = 1000.0 / np.tan(0.5 * field_of_view)
    circle = Circle(1000.0, 700.0, focal_length * np.tan(np.arcsin(1.0 / distance)))
    assert distance_from_view(circle, 2000.0, field_of_view) == pytest.approx(distance)


@pytest.mark.slow
@pytest.mark.parametrize(("distance", "elevation"), [(4.0, 0.0), (np.inf, 0.0), (8.0, 0.5)])
def test_one_side_unwraps_to_its_surroundings(distance: float, elevation: float) -> None:
    radiance, gains = environment_from_balls([side_seen(0.7, distance, elevation)], 128, 0.2)
    # The ball's 240 pixels resolve details of 15 degrees well but for its edge
    median, most = error_quantiles(radiance, 0.5, 0.85)
    assert median < 0.01
    assert most < 0.05
    assert gains == [1.0]


@pytest.mark.slow
def test_two_sides_show_what_either_hides() -> None:
    camera = np.radians(15.0)
    first, second = (side_seen(turn, 6.0, camera=camera) for turn in (0.0, np.radians(100.0)))
    one, _ = environment_from_balls([first], 128, camera)
    dimmer = BallSide(second.picture / 3.0, second.turn, 0.0, 6.0)
    two, gains = environment_from_balls([first, dimmer], 128, camera)
    assert gains[1] == pytest.approx(3.0, rel=0.01)
    towards_camera = EQUIRECT.texel_directions(128)[0] @ first.representation.frame[:, 2]
    hidden = (towards_camera > np.cos(0.9 * camera)) | (towards_camera < -np.cos(0.9 * np.arcsin(1 / 6.0)))
    error_one, error_two = (np.abs(image / EXPECTED - 1.0).max(axis=-1) for image in (one, two))
    # The camera is black in the one; what lies behind the ball is what its edge shows
    assert np.median(error_one[hidden]) > 0.5
    assert error_two[hidden].max() < 0.1
    median, most = error_quantiles(two, 0.5, 0.99)
    assert median < 0.01
    assert most < 0.1


def test_sides_without_light_in_common() -> None:
    lit = BallSide(np.ones((8, 8, 3)))
    black = BallSide(np.zeros((8, 8, 3)), 1.5)
    with pytest.raises(RangeError, match="share nothing but black: expose them longer"):
        environment_from_balls([lit, black], 16, 0.2)


def test_the_blind_spot_and_the_camera_have_values_all_the_same() -> None:
    radiance, _ = environment_from_balls([BallSide(np.full((8, 8, 3), 0.25), distance=2.0)], 16, 3.0)
    np.testing.assert_allclose(radiance, 0.25)
