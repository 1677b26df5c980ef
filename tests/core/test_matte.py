"""What is behind an object: where pixels look, what the floor loses, and how pictures fill a frame."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import RangeError
from rsibr.rsibr_addon.core.geometry.camera import Camera
from rsibr.rsibr_addon.core.pictures.matte import (
    EXTENT,
    backdrop_directions,
    fitted,
    flattened,
    floor_area,
    floor_from_world,
    floor_share,
    over,
    rays,
)
from rsibr.rsibr_addon.settings.matte import MatteOptions

CAMERAS = pytest.mark.parametrize(
    "camera", [Camera((0.3, -1.0, 0.8)), Camera((0.3, -1.0, 0.8), 0.6)], ids=["orthographic", "perspective"]
)
RNG = np.random.default_rng(95)


@CAMERAS
def test_points_of_rays_are_drawn_at_their_pixels(camera: Camera) -> None:
    size = 16
    origins, directions = rays(camera, size)
    points = origins + RNG.uniform(1.0, 5.0, (size, size, 1)) * directions
    there = np.concatenate([points, np.ones((size, size, 1))], axis=-1)
    clip = there @ (camera.projection @ np.linalg.inv(camera.world_from_camera)).T
    pixel = (0.5 + 0.5 * clip[..., :2] / clip[..., 3:]) * size
    np.testing.assert_allclose(pixel, np.stack(np.meshgrid(*2 * [np.arange(size) + 0.5]), axis=-1), atol=1e-9)


@CAMERAS
def test_a_backdrop_has_an_angle_of_view(camera: Camera) -> None:
    seen = backdrop_directions(camera, 64)
    np.testing.assert_allclose(seen.mean(axis=(0, 1)) @ camera.view_dir, -1.0, atol=0.05)
    across = np.arccos(seen[32, 0] @ seen[32, -1])
    assert across == pytest.approx(camera.field_of_view or np.radians(40.0), rel=0.05)


@CAMERAS
def test_the_floor_loses_light_where_its_map_says(camera: Camera) -> None:
    height, size, texels = -0.7, 64, 128
    x, y = np.meshgrid(*2 * [EXTENT * (2.0 * (np.arange(texels) + 0.5) / texels - 1.0)])
    shadow = np.stack([0.5 + 0.1 * x, 0.5 - 0.1 * y, np.full_like(x, 4.0)], axis=-1)
    share = floor_share(camera, height, shadow, np.array([2.0, 2.0, 2.0]), size)
    origins, directions = rays(camera, size)
    along = (height - origins[..., 2]) / directions[..., 2]
    px, py, _ = np.moveaxis(origins + along[..., None] * directions, -1, 0)
    near = (np.hypot(px, py) < 0.75 * EXTENT) & (along > 0.0)
    assert near.mean() > 0.5
    np.testing.assert_allclose(share[near, 0], 1.0 - (0.5 + 0.1 * px[near]) / 2.0, atol=1e-9)
    np.testing.assert_allclose(share[near, 1], 1.0 - (0.5 - 0.1 * py[near]) / 2.0, atol=1e-9)
    assert np.all(share[near, 2] == 0.0)
    far = np.hypot(px, py) > EXTENT
    assert np.all(share[far | (along < 0.0)] == 1.0)


def test_a_floor_is_not_seen_from_below() -> None:
    shadow = np.ones((8, 8, 3))
    for view in ((0.3, -1.0, -0.5), (0.0, -1.0, 0.0)):
        assert np.all(floor_share(Camera(view), -1.0, shadow, np.ones(3), 16) == 1.0)


def test_a_point_and_its_shadow_are_in_line_with_the_lamp() -> None:
    direction = np.array([0.6, -0.3, 0.2])
    direction /= np.linalg.norm(direction)
    points = RNG.uniform(-1.0, 1.0, (50, 3))
    shadow = np.c_[points, np.ones(50)] @ flattened(direction, -1.0).T
    lit = np.c_[shadow[:, :2], np.full(50, -1.0)]
    towards = points - lit
    np.testing.assert_allclose(np.cross(towards, direction), 0.0, atol=1e-12)
    assert np.all(shadow[:, 2:] == (0.0, 1.0))


@pytest.mark.parametrize(("height", "width", "size"), [(10, 16, 4), (7, 7, 5), (3, 5, 12), (6, 6, 6)])
def test_a_picture_fills_the_frame_with_its_middle(height: int, width: int, size: int) -> None:
    picture = RNG.random((height, width, 3))
    side = min(height, width)
    top, left = (height - side) // 2, (width - side) // 2
    middle = picture[top : top + side, left : left + side]
    made = fitted(picture, size)
    assert made.shape == (size, size, 3)
    np.testing.assert_allclose(made.mean(axis=(0, 1)), middle.mean(axis=(0, 1)), rtol=1e-12)
    if side == size:
        np.testing.assert_allclose(made, middle, rtol=1e-12)
    # Texel by texel, on a grid that both divide
    fine = np.repeat(np.repeat(middle, size, axis=0), size, axis=1)
    expected = fine.reshape(size, side, size, side, 3).mean(axis=(1, 3))
    np.testing.assert_allclose(made, expected, rtol=1e-12)


def test_coverage_decides_between_object_and_background() -> None:
    picture = np.array([[[0.0, 0.0, 0.0, 0.0], [0.2, 0.4, 0.6, 1.0], [0.1, 0.2, 0.3, 0.5]]])
    behind = np.full((1, 3, 3), 2.0)
    expected = [[[2.0, 2.0, 2.0, 1.0], [0.2, 0.4, 0.6, 1.0], [1.1, 1.2, 1.3, 1.0]]]
    np.testing.assert_allclose(over(picture, behind), expected, rtol=1e-6)


def test_blur_and_exposure_need_a_background() -> None:
    MatteOptions(background="light", background_blur=3.0, background_exposure=-1.0)
    with pytest.raises(RangeError, match="Only light can be blurred: choose light"):
        MatteOptions(background="photo.exr", background_blur=3.0)
    with pytest.raises(RangeError, match="no background to expose: choose one"):
        MatteOptions(background_exposure=1.0)


@pytest.mark.parametrize("flat", [False, True])
def test_a_floor_has_coordinates_of_its_own(flat: bool) -> None:
    """Those of a plane that a matrix shears, also of one without thickness; the eye is above."""
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = RNG.normal(size=(3, 3)), (1.0, -2.0, 0.5)
    if flat:
        matrix[:3, 2] = 0.0
    points = np.concatenate([RNG.normal(size=(5, 2)), np.full((5, 1), 0.7)], axis=1)
    placed = points @ matrix[:3, :3].T + matrix[:3, 3]
    for eye in ((3.0, 2.0, 1.0, 1.0), (-3.0, 2.0, -1.0, 1.0), (0.3, -0.5, 0.2, 0.0)):
        floor = floor_from_world(matrix, np.array([points[0], [0.0, 0.0, 1.0]]), np.array(eye))
        assert floor is not None
        np.testing.assert_allclose(floor[:3, :3] @ floor[:3, :3].T, np.eye(3), atol=1e-12)
        assert np.linalg.det(floor[:3, :3]) == pytest.approx(1.0)
        np.testing.assert_allclose((placed @ floor[:3, :3].T + floor[:3, 3])[:, 2], 0.0, atol=1e-12)
        assert (floor @ eye)[2] > 0.0
    assert floor_from_world(np.diag([1.0, 0.0, 1.0, 1.0]), np.eye(3)[[0, 2]], np.array(eye)) is None


def test_what_stands_on_a_floor_is_where_shadows_do_not_fade() -> None:
    corners = RNG.uniform((-3.0, 2.0, 0.0), (5.0, 2.5, 0.1), (50, 3))
    middle, half_width = floor_area(corners)
    assert np.linalg.norm(corners[:, :2] - middle, axis=1).max() <= 0.75 * half_width
    assert floor_area(corners + (0.0, 0.0, 2.0))[1] == pytest.approx(half_width + 3.0)
