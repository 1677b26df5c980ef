"""The camera fits the unit sphere and nothing but the unit sphere."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import RangeError
from rsibr.rsibr_addon.core.geometry.camera import Camera
from rsibr.rsibr_addon.core.geometry.directions import normalize

VIEW_DIRS = [(0.3, -0.8, 0.45), (0.0, 0.0, 2.0), (0.0, 0.0, -1.0), (-5.0, 0.0, 0.0)]
FIELDS_OF_VIEW = [None, *np.deg2rad([0.5, 20.0, 90.0, 150.0, 178.0])]
CAMERAS = [Camera(view_dir, angle) for view_dir in VIEW_DIRS for angle in FIELDS_OF_VIEW]
SPHERE = normalize(np.random.default_rng(2).normal(size=(20000, 3)))


def clip_coordinates(camera: Camera, points: np.ndarray) -> np.ndarray:
    homogeneous = np.concatenate([points, np.ones((*points.shape[:-1], 1))], axis=-1)
    return homogeneous @ (camera.projection @ np.linalg.inv(camera.world_from_camera)).T


def seen_points(camera: Camera, points: np.ndarray) -> np.ndarray:
    """Points of the unit sphere whose tangent plane the eye is above."""
    eye = camera.eye
    return points[np.sum(points * (eye[:3] - eye[3] * points), axis=-1) > 0.0]


@pytest.mark.parametrize("camera", CAMERAS, ids=str)
def test_the_unit_sphere_fills_the_frame_exactly(camera: Camera) -> None:
    # In a plane through the eye, the tangent points stand at height sin(half angle) over the origin.
    z = 0.0 if camera.field_of_view is None else np.sin(camera.field_of_view / 2.0)
    side = np.sqrt(1.0 - z * z)
    right, up, back = camera.frame.T
    outermost = np.array([side * right, -side * right, side * up, -side * up]) + z * back
    clip = clip_coordinates(camera, outermost)
    np.testing.assert_allclose(clip[:, :2] / clip[:, 3:], [(1, 0), (-1, 0), (0, 1), (0, -1)], atol=1e-9)
    clip = clip_coordinates(camera, seen_points(camera, SPHERE))
    assert np.all(np.abs(clip[:, :2]) <= clip[:, 3:] * (1.0 + 1e-9))


@pytest.mark.parametrize("camera", CAMERAS, ids=str)
def test_no_visible_point_of_the_sphere_is_clipped(camera: Camera) -> None:
    nearest = np.asarray(camera.view_dir)[None]
    clip = clip_coordinates(camera, np.concatenate([nearest, seen_points(camera, SPHERE)]))
    assert np.all(np.abs(clip[:, 2]) < clip[:, 3])
    depth = clip[:, 2] / clip[:, 3]
    assert np.argmin(depth) == 0  # the nearest point has the least depth


@pytest.mark.parametrize("camera", CAMERAS, ids=str)
def test_the_eye_is_where_the_pose_puts_it(camera: Camera) -> None:
    position = camera.world_from_camera[:3, 3]
    np.testing.assert_allclose(position, camera.distance * np.asarray(camera.view_dir), rtol=1e-15)
    np.testing.assert_array_equal(camera.world_from_camera[:3, :3], camera.frame)
    point = np.array([0.2, 0.3, -0.4])
    to_eye = normalize(camera.eye[:3] - camera.eye[3] * point)
    expected = camera.view_dir if camera.field_of_view is None else normalize(position - point)
    np.testing.assert_allclose(to_eye, expected, atol=1e-15)


def test_distance_in_perspective() -> None:
    assert Camera((1.0, 0.0, 0.0), np.pi / 3.0).distance == pytest.approx(2.0, rel=1e-15)


@pytest.mark.parametrize("angle", [0.0, -1.0, np.pi, 4.0, np.nan])
def test_angles_that_no_camera_has_are_refused(angle: float) -> None:
    with pytest.raises(RangeError, match="between 0 and 180 degrees"):
        Camera((1.0, 0.0, 0.0), angle)


def test_a_view_from_nowhere_is_refused() -> None:
    with pytest.raises(RangeError, match="length 0"):
        Camera((0.0, 0.0, 0.0))


def test_equal_views_are_equal_cameras() -> None:
    assert Camera((0.0, 3.0, 4.0)) == Camera((0.0, 0.6, 0.8))
    assert Camera((0.0, 3.0, 4.0)).view_dir == (0.0, 0.6, 0.8)
