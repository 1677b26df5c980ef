"""Changing light on the GPU against its reference in numpy: harmonics, mips, and the pictures they make."""

from dataclasses import replace

import gpu
import numpy as np
import pytest
from rsibr.rsibr_addon.core.conventions import Array
from rsibr.rsibr_addon.core.errors import RangeError
from rsibr.rsibr_addon.core.filtering.irradiance import irradiance_coefficients
from rsibr.rsibr_addon.core.geometry.camera import Camera
from rsibr.rsibr_addon.core.geometry.near_room import Room
from rsibr.rsibr_addon.core.kinds.live_environment import chain_of_faces, harmonics_of_faces
from rsibr.rsibr_addon.core.kinds.mip_chain.shading import MipLook
from rsibr.rsibr_addon.core.kinds.mip_chain.texture_space import box_halved, tent_halved
from rsibr.rsibr_addon.core.maps.representation import representation
from rsibr.rsibr_addon.device import buffers
from rsibr.rsibr_addon.device.context import ensure_context
from rsibr.rsibr_addon.device.kinds.live_environment import GpuLiveEnvironment
from rsibr.rsibr_addon.device.kinds.mip_chain import GpuMipChain, atlas_texels
from rsibr.rsibr_addon.device.preview import PreviewRenderer
from rsibr.tests.glsl.test_preview_renderer import SIZE, SPHERE

FILTERS = pytest.mark.parametrize("across_borders", [True, False])


def random_faces(size: int, seed: int = 51) -> Array:
    return np.random.default_rng(seed).random((6, size, size, 3), dtype=np.float32)


def smooth_faces(size: int) -> Array:
    direction = representation("cube_map").texel_directions(size)
    return np.float32(0.5 + 0.2 * np.sin(3.0 * direction + (0.0, 1.0, 2.0)))


def show(live: GpuLiveEnvironment, faces: Array, numbers: range = range(6)) -> None:
    """Give some of six faces as renders."""
    for number in numbers:
        texels = np.ones((*faces.shape[1:3], 4), dtype=np.float32)
        texels[..., :3] = faces[number]
        live.set_face(number, buffers.texture(texels))
    live.filter()


def read(image) -> Array:
    """All of a map that the GPU drew, shape (height, width, 3)."""
    width, height = image.texture.width, image.texture.height
    return np.array(image.framebuffer.read_color(0, 0, width, height, 4, 0, "FLOAT"))[..., :3]


def reference(faces: Array, across_borders: bool):
    return chain_of_faces(faces, tent_halved if across_borders else box_halved)


@FILTERS
@pytest.mark.parametrize("size", [1, 2, 16, 64])
def test_mips_and_harmonics(size: int, across_borders: bool) -> None:
    ensure_context()
    faces = random_faces(size)
    live = GpuLiveEnvironment(size, across_borders)
    show(live, faces)
    expected = reference(faces, across_borders)
    atlas, expected_atlas = read(live._atlas), atlas_texels(expected)[..., :3]
    assert atlas.shape == expected_atlas.shape
    for mip in range(size.bit_length()):
        rows = (size >> mip) + 2
        bottom = 2 * (size - (size >> mip) + mip)
        there = slice(bottom, bottom + rows), slice(0, 6 * rows)
        # A few roundings at each mip, of values up to 1.
        assert np.abs(atlas[there] - expected_atlas[there]).max() < (1 + mip) * 2e-7
    coefficients = irradiance_coefficients(expected.harmonics)
    assert np.abs(read(live._harmonics)[0] - coefficients).max() < 1e-5 * np.abs(coefficients).max()


def test_harmonics_of_a_higher_degree() -> None:
    ensure_context()
    faces = random_faces(16)
    live = GpuLiveEnvironment(16, degree=6)
    show(live, faces)
    coefficients = irradiance_coefficients(harmonics_of_faces(faces, 6))
    assert coefficients.shape == (49, 3)
    assert np.abs(read(live._harmonics)[0] - coefficients).max() < 1e-5 * np.abs(coefficients).max()


def test_a_face_changes_alone() -> None:
    ensure_context()
    before, after = random_faces(8, 52), random_faces(8, 53)
    live = GpuLiveEnvironment(8)
    show(live, before)
    show(live, after, range(2, 3))
    before[2] = after[2]
    expected = reference(before, True)
    np.testing.assert_array_equal(read(live._faces), np.concatenate(list(before), axis=1))
    coefficients = irradiance_coefficients(expected.harmonics)
    assert np.abs(read(live._harmonics)[0] - coefficients).max() < 1e-5 * 4.0 * np.pi


def test_what_is_no_radiance_is_black_or_bounded() -> None:
    ensure_context()
    faces = np.full((6, 4, 4, 3), 0.5, dtype=np.float32)
    faces[0, 0, :3, 0] = (np.nan, np.inf, -1.0)
    live = GpuLiveEnvironment(4)
    show(live, faces)
    np.testing.assert_array_equal(read(live._faces)[0, :3], [(0, 0.5, 0.5), (65504, 0.5, 0.5), (0, 0.5, 0.5)])
    assert np.isfinite(read(live._atlas)).all()


@FILTERS
@pytest.mark.parametrize(
    "blur", [{"mip": 0.0}, {"mip": 1.6}, {"mip": 9.4}, {"roughness": 0.3}, {"exponent": 50.0}]
)
def test_a_picture_is_that_of_the_uploaded_chain(across_borders: bool, blur: dict) -> None:
    ensure_context()
    faces = smooth_faces(32)
    live = GpuLiveEnvironment(32, across_borders)
    show(live, faces)
    look = MipLook(f0=(0.3, 0.5, 0.9), kd=(0.9, 0.5, 0.1), **blur)
    camera = Camera((1.0, -0.7, 0.4), 0.6)
    uploaded = GpuMipChain(reference(faces, across_borders))
    pictures = [PreviewRenderer(subject).draw(*SPHERE, camera, SIZE, look) for subject in (live, uploaded)]
    assert pictures[0][..., :3].max() > 0.1
    # The same lookups, of texels and coefficients that differ by roundings.
    assert np.abs(pictures[0] - pictures[1]).max() < 1e-5


def test_in_a_room_light_is_seen_from_where_it_was_rendered() -> None:
    ensure_context()
    faces = smooth_faces(32)
    live, at = GpuLiveEnvironment(32), (0.5, -0.4, 0.3)
    show(live, faces)
    live.captured_at = at
    room = MipLook(f0=(1.0,) * 3, kd=(0.0,) * 3, room=Room.BOX, room_size=(5.0, 4.4, 4.0))
    camera, uploaded = Camera((1.0, -0.7, 0.4)), GpuMipChain(reference(faces, True))
    found = PreviewRenderer(live).draw(*SPHERE, camera, SIZE, room)
    expected = PreviewRenderer(uploaded).draw(*SPHERE, camera, SIZE, replace(room, captured_at=at))
    # As of pictures, above
    assert np.abs(found - expected).max() < 1e-5
    elsewhere = PreviewRenderer(uploaded).draw(*SPHERE, camera, SIZE, room)
    assert np.abs(elsewhere - expected).max() > 0.01


def test_black_at_first_and_bad_requests() -> None:
    ensure_context()
    live = GpuLiveEnvironment(4)
    camera = Camera((0.0, -1.0, 0.0))
    picture = PreviewRenderer(live).draw(*SPHERE, camera, SIZE, MipLook())
    assert picture[..., 3].max() == 1.0
    assert picture[..., :3].max() == 0.0
    with pytest.raises(RangeError, match=r"^A mip chain cannot be 24 texels wide: choose a power of 2"):
        GpuLiveEnvironment(24)


def test_filtering_leaves_blender_s_state_alone() -> None:
    ensure_context()
    gpu.state.depth_test_set("LESS_EQUAL")
    gpu.state.blend_set("ALPHA")
    try:
        live = GpuLiveEnvironment(4)
        show(live, random_faces(4))
        assert (gpu.state.depth_test_get(), gpu.state.blend_get()) == ("LESS_EQUAL", "ALPHA")
        np.testing.assert_array_equal(read(live._faces), np.concatenate(list(random_faces(4)), axis=1))
    finally:
        gpu.state.depth_test_set("NONE")
        gpu.state.blend_set("NONE")
