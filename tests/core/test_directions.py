"""Unit vectors and the camera's axes."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import RangeError
from rsibr.rsibr_addon.core.geometry.directions import (
    camera_frame,
    dot,
    mirror_normal,
    normalize,
    reflect,
    refract,
    transformed_normal,
)

RNG = np.random.default_rng(1)
DIRECTIONS = normalize(RNG.normal(size=(500, 3)))
OTHERS = normalize(RNG.normal(size=(500, 3)))


def test_dot_broadcasts() -> None:
    assert dot([1.0, 2.0, 3.0], [4.0, -5.0, 6.0]) == 12.0
    products = dot(DIRECTIONS[:4, None], OTHERS[None, :5])
    np.testing.assert_allclose(products, DIRECTIONS[:4] @ OTHERS[:5].T, atol=1e-15)


def test_normalize_keeps_the_direction() -> None:
    lengths = 10.0 ** RNG.uniform(-150.0, 150.0, size=(500, 1))
    np.testing.assert_allclose(normalize(DIRECTIONS * lengths), DIRECTIONS, rtol=1e-13)
    np.testing.assert_array_equal(normalize((0, -7, 0)), [0.0, -1.0, 0.0])


@pytest.mark.parametrize("bad", [(0.0, 0.0, 0.0), (1.0, np.nan, 0.0), (np.inf, 0.0, 0.0)])
def test_what_has_no_direction_is_refused(bad: tuple[float, float, float]) -> None:
    with pytest.raises(RangeError, match="no direction: give one"):
        normalize([(1.0, 0.0, 0.0), bad])


def test_a_mirror_obeys_the_law_of_reflection() -> None:
    mirrored = reflect(DIRECTIONS, OTHERS)
    np.testing.assert_allclose(dot(mirrored, OTHERS), dot(DIRECTIONS, OTHERS), atol=1e-15)
    np.testing.assert_allclose(dot(mirrored, np.cross(DIRECTIONS, OTHERS)), 0.0, atol=1e-15)
    np.testing.assert_allclose(np.linalg.norm(mirrored, axis=-1), 1.0, rtol=1e-14)
    np.testing.assert_allclose(reflect(mirrored, OTHERS), DIRECTIONS, atol=1e-14)
    np.testing.assert_allclose(reflect(OTHERS, OTHERS), OTHERS, atol=1e-15)
    # Seen from +X, a surface that is tilted half-way to +Z shows what is above.
    np.testing.assert_allclose(reflect((1, 0, 0), normalize((1, 0, 1))), (0, 0, 1), atol=1e-15)


def test_a_mirror_has_the_normal_that_shows_a_direction() -> None:
    facing = np.where(dot(DIRECTIONS, OTHERS)[:, None] < 0.0, -OTHERS, OTHERS)
    np.testing.assert_allclose(mirror_normal(DIRECTIONS, reflect(DIRECTIONS, facing)), facing, atol=1e-10)
    np.testing.assert_array_equal(mirror_normal(DIRECTIONS, -DIRECTIONS), 0.0)
    np.testing.assert_array_equal(reflect(DIRECTIONS, np.zeros(3)), -DIRECTIONS)


@pytest.mark.parametrize("eta", [1.0, 1.5, 2.4, 0.75])
def test_refraction_obeys_snells_law(eta: float) -> None:
    facing = dot(DIRECTIONS, OTHERS)[:, None]
    view_dir, normal = DIRECTIONS[facing[:, 0] > 0.0], OTHERS[facing[:, 0] > 0.0]
    refracted = refract(view_dir, normal, eta)
    np.testing.assert_allclose(np.linalg.norm(refracted, axis=-1), 1.0, rtol=1e-14)
    np.testing.assert_allclose(dot(refracted, np.cross(view_dir, normal)), 0.0, atol=1e-15)
    sine_outside = np.linalg.norm(np.cross(view_dir, normal), axis=-1)
    sine_inside = np.linalg.norm(np.cross(refracted, normal), axis=-1)
    passes = sine_outside < eta
    np.testing.assert_allclose(eta * sine_inside[passes], sine_outside[passes], atol=1e-14)
    # On the other side of the normal and of the surface; beyond the critical angle along it.
    across = dot(refracted, view_dir) - dot(refracted, normal) * dot(view_dir, normal)
    assert np.all(across <= 1e-14)
    assert np.all(dot(refracted, normal)[passes] < 0.0)
    assert np.count_nonzero(~passes) == 0 or eta < 1.0
    np.testing.assert_allclose(dot(refracted, normal)[~passes], 0.0, atol=1e-14)


def test_refraction_in_numbers() -> None:
    # Light at 45 degrees goes on at 30 in a material of index sqrt(2).
    view_dir = (np.sqrt(0.5), 0.0, np.sqrt(0.5))
    expected = (-0.5, 0.0, -np.sqrt(0.75))
    np.testing.assert_allclose(refract(view_dir, (0.0, 0.0, 1.0), np.sqrt(2.0)), expected, atol=1e-15)


POLES = np.array([(0.0, 0.0, 1.0), (0.0, 0.0, -1.0)])


def test_a_transformed_normal_is_that_of_the_transformed_surface() -> None:
    rng = np.random.default_rng(8)
    matrix, along, across = rng.normal(size=(50, 3, 3)), rng.normal(size=(50, 3)), rng.normal(size=(50, 3))
    normal = transformed_normal(matrix, np.cross(along, across))
    for tangent in (along, across):
        np.testing.assert_allclose(dot(normal, np.einsum("nij,nj->ni", matrix, tangent)), 0.0, atol=1e-12)
    # What was outside stays outside, in a mirror too
    outside = along + across + np.cross(along, across)
    assert np.all(dot(normal, np.einsum("nij,nj->ni", matrix, outside)) > 0.0)
    flat = np.diag([1.0, 2.0, 0.0])
    np.testing.assert_array_equal(transformed_normal(flat, (0.6, 0.0, 0.8)), (0.0, 0.0, 1.6))


def test_a_camera_stands_upright_and_looks_at_the_origin() -> None:
    frames = camera_frame(np.concatenate([DIRECTIONS, POLES]).reshape(-1, 2, 3)).reshape(-1, 3, 3)
    np.testing.assert_allclose(
        np.swapaxes(frames, -1, -2) @ frames, np.broadcast_to(np.eye(3), frames.shape), atol=1e-14
    )
    np.testing.assert_allclose(np.linalg.det(frames), 1.0, rtol=1e-14)
    np.testing.assert_array_equal(frames[..., 2], np.concatenate([DIRECTIONS, POLES]))
    np.testing.assert_array_equal(frames[..., 2, 0], 0.0)  # x lies in the horizon's plane,
    assert np.all(frames[:-2, 2, 1] > 0.0)  # and y points upwards.


def test_an_eye_on_the_y_axis_sees_x_to_the_left() -> None:
    np.testing.assert_array_equal(camera_frame((0.0, 1.0, 0.0)), [[-1, 0, 0], [0, 0, 1], [0, 1, 0]])


@pytest.mark.needs("bpy")
def test_a_camera_stands_as_blenders_to_track_quat() -> None:
    import mathutils

    # Single precision: Blender turns by acos(z), whose error, 1e-7 / sin, is below 1e-4 from 0.01 rad on.
    off_poles = DIRECTIONS[np.hypot(DIRECTIONS[:, 0], DIRECTIONS[:, 1]) > 0.01]
    near_poles = normalize([(0.01, 0.0, 1.0), (0.0, -0.01, 1.0), (-0.008, 0.007, -1.0)])
    axes = np.concatenate([np.eye(3), -np.eye(3)])  # the poles among them
    directions = np.concatenate([off_poles, near_poles, axes])
    blenders = [mathutils.Vector(d).to_track_quat("Z", "Y").to_matrix() for d in directions]
    np.testing.assert_allclose(camera_frame(directions), np.array(blenders), atol=1e-4)
