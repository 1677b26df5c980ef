"""Rays in a box and in an ellipsoid, and mirrors in a room whose walls are known."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.geometry.directions import normalize
from rsibr.rsibr_addon.core.geometry.near_room import Room, near_direction, outside_distance

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
def test_far_away_directions_stay(room: Room) -> None:
    far = near_direction(INSIDE, DIRECTIONS, room, 1e6 * HALF, MIDDLE)
    np.testing.assert_allclose(far, DIRECTIONS, atol=4e-6)


NEAR = [Room.BOX, Room.SPHERE]


@pytest.mark.parametrize("room", NEAR)
def test_light_does_not_jump_where_one_leaves_the_room(room: Room) -> None:
    on_wall = DIRECTIONS / HALF
    on_wall = np.abs(on_wall).max(axis=1) if room is Room.BOX else np.linalg.norm(on_wall, axis=1)
    wall, rays = DIRECTIONS / on_wall[:, None], np.roll(DIRECTIONS, 7, axis=0)
    just_in, just_out = (
        near_direction(MIDDLE + share * wall, rays, room, HALF, MIDDLE) for share in (1.0 - 1e-7, 1.0 + 1e-7)
    )
    # But for rays along the wall, which meet it anywhere
    apart = np.linalg.norm(just_in - just_out, axis=1)
    assert np.mean(apart < 1e-4) > 0.95


@pytest.mark.parametrize("room", NEAR)
def test_the_way_out_of_a_room(room: Room) -> None:
    assert np.all(outside_distance(INSIDE - MIDDLE, room, HALF) == 0.0)
    along_x = outside_distance([2.5, 0.0, 0.0], room, HALF)
    assert along_x == pytest.approx(0.5)
    at_once = outside_distance(np.zeros(3), room, HALF)
    assert at_once == 0.0


def test_beyond_a_corner_and_beside_an_ellipsoid_the_way_is_aslant() -> None:
    assert outside_distance(HALF + [0.3, 0.4, 0.0], Room.BOX, HALF) == pytest.approx(0.5)
    wall = DIRECTIONS / np.linalg.norm(DIRECTIONS / HALF, axis=1)[:, None]
    beyond = outside_distance(1.5 * wall, Room.SPHERE, HALF)
    np.testing.assert_allclose(beyond, 0.5 * np.linalg.norm(wall, axis=1), rtol=1e-12)
