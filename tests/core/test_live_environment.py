"""Light from six renders: where they look, and nine coefficients of what they show."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import RangeError
from rsibr.rsibr_addon.core.filtering.irradiance import real_harmonics
from rsibr.rsibr_addon.core.kinds.live_environment import (
    chain_of_faces,
    face_projection,
    face_view,
    faces_due,
    faces_within,
    harmonics_of_faces,
    near_distances,
    solid_angle_texels,
)
from rsibr.rsibr_addon.core.kinds.mip_chain.texture_space import box_halved, tent_halved
from rsibr.rsibr_addon.core.maps import cube_map
from rsibr.rsibr_addon.core.maps.representation import representation


@pytest.mark.parametrize("size", [1, 4, 16])
def test_constant_light_has_one_coefficient(size: int) -> None:
    found = harmonics_of_faces(np.full((6, size, size, 3), 2.0))
    expected = np.zeros((9, 3))
    expected[0] = 2.0 * np.sqrt(4.0 * np.pi)
    np.testing.assert_allclose(found, expected, atol=1e-13)


@pytest.mark.parametrize("size", [8, 16, 64])
def test_harmonics_are_orthonormal_but_for_the_texels_size(size: int) -> None:
    faces = real_harmonics(representation("cube_map").texel_directions(size), 2)
    found = harmonics_of_faces(faces)
    # The midpoint rule errs by (second derivative) * (2 / n)^2 / 24, summed over 4 pi: products of harmonics
    # turn up to 4 times as fast as directions do, 16 * 4 / 24 / n^2 * 4 pi * 0.3 < 12 / n^2.
    np.testing.assert_allclose(found, np.eye(9), atol=12.0 / size**2)


def test_one_texel() -> None:
    faces = np.zeros((6, 8, 8, 3), dtype=np.float32)
    faces[3, 2, 5] = (1.0, 2.0, 4.0)
    direction = representation("cube_map").texel_directions(8)[3, 2, 5]
    expected = real_harmonics(direction, 2)[:, None] * cube_map.texel_solid_angle(8)[3, 2, 5] * faces[3, 2, 5]
    np.testing.assert_allclose(harmonics_of_faces(faces), expected, rtol=1e-13)


@pytest.mark.parametrize("halved", [box_halved, tent_halved])
def test_a_chain_ends_with_one_texel(halved) -> None:
    faces = np.random.default_rng(1).random((6, 8, 8, 3), dtype=np.float32)
    chain = chain_of_faces(faces, halved)
    assert [mip.shape[1] for mip in chain.mips] == [8, 4, 2, 1]
    assert {mip.dtype for mip in chain.mips} == {np.dtype(np.float32)}
    np.testing.assert_array_equal(chain.mips[1], halved(faces).astype(np.float32))
    with pytest.raises(RangeError, match="choose a power of 2"):
        chain_of_faces(np.zeros((6, 6, 6, 3)), lambda faces: faces[:, :1, :1])


def test_solid_angles_of_every_mip() -> None:
    texels = solid_angle_texels(8)
    assert texels.shape == (15, 8)
    for bottom, size in ((0, 8), (8, 4), (12, 2), (14, 1)):
        mip = texels[bottom : bottom + size]
        np.testing.assert_array_equal(mip[:, :size], cube_map.texel_solid_angle(size)[0])
        assert not mip[:, size:].any()


@pytest.mark.parametrize("face", range(6))
def test_a_face_is_seen_as_the_cube_map_stores_it(face: int) -> None:
    centre = np.array([3.0, -2.0, 0.5])
    uv = np.random.default_rng(face).random((100, 2))
    points = centre + 7.0 * cube_map.direction_from_uv(uv, np.full(100, face))
    clip = np.c_[points, np.ones(100)] @ (face_projection(0.1, 50.0) @ face_view(face, centre)).T
    assert np.all(clip[:, 3] > 0.0)
    np.testing.assert_allclose(0.5 + 0.5 * clip[:, :2] / clip[:, 3:], uv, atol=1e-12)


@pytest.mark.parametrize(("distance", "depth"), [(0.25, -1.0), (40.0, 1.0)])
def test_planes_that_cut_off(distance: float, depth: float) -> None:
    clip = face_projection(0.25, 40.0) @ face_view(4, (0.0, 0.0, 0.0)) @ (0.0, 0.0, distance, 1.0)
    assert clip[2] / clip[3] == pytest.approx(depth, abs=1e-12)
    assert clip[3] == pytest.approx(distance)


@pytest.mark.parametrize("face", range(6))
def test_a_view_is_a_rotation(face: int) -> None:
    rotation = face_view(face, (1.0, 2.0, 3.0))[:3, :3]
    np.testing.assert_array_equal(rotation @ rotation.T, np.eye(3))
    assert np.linalg.det(rotation) == pytest.approx(1.0)


def test_an_object_is_cut_off_and_its_floor_is_not() -> None:
    half = np.array([1.0, 2.0, 3.0])
    corners = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * half
    assert np.all(near_distances(corners) > np.repeat(half, 2))
    np.testing.assert_allclose(near_distances(corners), np.repeat(half, 2), rtol=2e-3)
    polar, azimuth = np.meshgrid(np.linspace(0.0, np.pi, 257), np.linspace(0.0, 2.0 * np.pi, 513))
    ring = np.sin(polar)
    sphere = np.stack([ring * np.cos(azimuth), ring * np.sin(azimuth), np.cos(polar)], axis=-1).reshape(-1, 3)
    near = near_distances(sphere)
    assert np.all(near < 1.0)
    # What sticks out spans less than half a texel of a face of 128: two right angles over 256.
    assert np.all(np.arccos(near) < np.pi / 2.0 / 256.0)


def test_a_cone_is_flat_below_and_a_tip_above() -> None:
    angle = np.linspace(0.0, 2.0 * np.pi, 64, endpoint=False)
    base = np.stack([np.cos(angle), np.sin(angle), np.full_like(angle, -1.0)], axis=-1)
    near = near_distances(np.concatenate([base, [(0.0, 0.0, 1.0)]]))
    assert near[4] < 1.0 < near[5]


def test_faces_take_turns() -> None:
    assert faces_due(6, 0, 6) == (0, 1, 2, 3, 4, 5)
    assert faces_due(6, 4, 3) == (4, 5, 0)
    assert faces_due(1, 2, 3) == (2,)
    assert faces_due(0, 2, 3) == ()


def test_a_budget_in_seconds_is_faces() -> None:
    assert faces_within(0.02, []) == 1
    assert [faces_within(0.02, [seconds]) for seconds in (0.1, 0.02, 0.0099, 0.005, 1e-4)] == [1, 1, 2, 4, 6]
    # One of five that compiled programs
    assert faces_within(0.02, [10.0, 0.005, 0.005, 0.006, 0.005]) == 4
