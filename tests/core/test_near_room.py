"""Rays in a box and in an ellipsoid, and mirrors in a room whose walls are known."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.geometry.directions import normalize
from rsibr.rsibr_addon.core.geometry.near_room import Room, near_direction

RNG = np.random.default_rng(97)
HALF, MIDDLE = np.array([2.0, 1.5, 1.0]), np.array([0.3, -0.2, 0.1])
DIRECTIONS = normalize(np.concatenate([RNG.normal(size=(500, 3)), np.eye(3), -np.eye(3)]))
INSIDE = MIDDLE + RNG.uniform(-0.55, 0.55, DIRECTIONS.shape) * HALF


@pytest.mark.parametrize("room", [Room.BOX, Room.SPHERE])
def test_a_map_is_looked_up_where_the_ray_meets_the_wall(room: Room) -> None:
    found = near_direction(INSIDE, DIRECTIONS, room, HALF, MIDDLE)
    # From the capture point, walk to the plane of the ray: the two lines meet
    for position, direction, towards in zip(INSIDE, DIRECTIONS, found, strict=True):
        (t, s), *_ = np.linalg.lstsq(np.stack([direction, -towards], axis=-1), -position, rcond=None)
        hit = position + t * direction
        np.testing.assert_allclose(hit, s * towards, atol=1e-9)
        on_wall = (hit - MIDDLE) / HALF
        reach = np.abs(on_wall).max() if room is Room.BOX else np.linalg.norm(on_wall)
        assert t > 0.0
        assert reach == pytest.approx(1.0)


@pytest.mark.parametrize("room", Room)
def test_from_where_it_was_captured_a_map_is_as_it_is(room: Room) -> None:
    found = near_direction(np.zeros(3), DIRECTIONS, room, HALF, MIDDLE)
    np.testing.assert_allclose(found, DIRECTIONS, atol=1e-12)


@pytest.mark.parametrize("room", Room)
def test_outside_the_room_and_far_away_directions_stay(room: Room) -> None:
    outside = near_direction(MIDDLE + 3.0 * HALF, DIRECTIONS, room, HALF, MIDDLE)
    np.testing.assert_allclose(outside, DIRECTIONS, atol=1e-15)
    far = near_direction(INSIDE, DIRECTIONS, room, 1e6 * HALF, MIDDLE)
    np.testing.assert_allclose(far, DIRECTIONS, atol=4e-6)
