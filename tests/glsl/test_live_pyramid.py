"""Changing light filtered for own materials on the GPU, against its reference in numpy."""

import gpu
import numpy as np
import pytest
from rsibr.rsibr_addon.core.geometry.camera import Camera
from rsibr.rsibr_addon.core.geometry.directions import normalize
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.atlas import atlas_texels
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.live import live_pyramid
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.look import PrincipledLook
from rsibr.rsibr_addon.core.suns import lamp_suns
from rsibr.rsibr_addon.device.context import ensure_context
from rsibr.rsibr_addon.device.kinds.kernel_pyramid import GpuPyramid
from rsibr.rsibr_addon.device.kinds.live_pyramid import GpuLivePyramid
from rsibr.rsibr_addon.device.preview import PreviewRenderer
from rsibr.tests.glsl.principled_inputs import families
from rsibr.tests.glsl.test_live_environment import random_faces, read, show, smooth_faces
from rsibr.tests.glsl.test_preview_renderer import SIZE, SPHERE

FACE = 32

TOWARDS = normalize(np.array([[0.6, -0.5, 0.6], [0.1, -0.9, 0.3]]))
LAMPS = TOWARDS, np.array([[3.0, 2.0, 1.0], [0.5, 1.0, 2.0]]), 0.01
NONE = np.zeros((0, 3)), np.zeros((0, 3)), np.pi

ROUNDED = 1.0 / 256.0
"""Hardware may round the weights of bilinear lookups so."""


def test_every_map_is_the_reference_s() -> None:
    ensure_context()
    faces = random_faces(FACE)
    live = GpuLivePyramid(FACE, families())
    show(live, faces)
    expected, _ = atlas_texels(live_pyramid(faces))
    found = read(live._atlas)
    assert found.shape == expected.shape[:2] + (3,)
    for left, bottom, width, height in live._places:
        part = slice(bottom, bottom + height), slice(left, left + width)
        assert np.abs(found[part] - expected[part][..., :3]).max() < ROUNDED


def test_a_later_change_leaves_nothing_of_what_was() -> None:
    ensure_context()
    live, fresh = (GpuLivePyramid(FACE, families()) for _ in range(2))
    show(live, random_faces(FACE, 1))
    for each in (live, fresh):
        show(each, random_faces(FACE, 2))
    np.testing.assert_array_equal(read(live._atlas), read(fresh._atlas))


def test_the_same_lamps_are_not_uploaded_again() -> None:
    ensure_context()
    live = GpuLivePyramid(FACE, families())
    live.set_lamps(*LAMPS)
    lookups = live.textures[1]
    live.set_lamps(*(np.copy(each) if isinstance(each, np.ndarray) else each for each in LAMPS))
    assert live.textures[1] is lookups
    direction, irradiance, angle = LAMPS
    for lamps in (
        (direction[::-1], irradiance, angle),
        (direction, 2.0 * irradiance, angle),
        (*LAMPS[:2], 0.1),
    ):
        live.set_lamps(*lamps)
        assert live.textures[1] is not lookups
        lookups = live.textures[1]


@pytest.mark.slow
def test_suns_of_lamps_light_all_that_the_reference_lights() -> None:
    ensure_context()
    faces = smooth_faces(FACE)
    live = GpuLivePyramid(FACE, families())
    camera = Camera((1.0, -0.7, 0.4), 0.6)
    look = PrincipledLook(
        own=False, roughness=0.3, diffuse_roughness=1.0, sheen_weight=1.0, sheen_roughness=0.5
    )
    for lamps in (LAMPS, NONE):
        live.set_lamps(*lamps)
        show(live, faces)
        uploaded = GpuPyramid(live_pyramid(faces, lamp_suns(*lamps)), families())
        found, expected = (PreviewRenderer(it).draw(*SPHERE, camera, SIZE, look) for it in (live, uploaded))
        # Half floats of what is uploaded, whose differences lobes magnify: as of `principled_radiance`
        assert np.abs(found - expected).max() < 2e-3 * expected.max()


@pytest.mark.slow
def test_a_picture_is_that_of_the_uploaded_pyramid() -> None:
    ensure_context()
    faces = smooth_faces(FACE)
    live = GpuLivePyramid(FACE, families())
    show(live, faces)
    uploaded = GpuPyramid(live_pyramid(faces), families())
    camera = Camera((1.0, -0.7, 0.4), 0.6)
    for inputs in ({"metallic": 1.0, "roughness": 0.3}, {"coat_weight": 1.0}, {"diffuse_roughness": 1.0}):
        look = PrincipledLook(own=False, **inputs)
        found, expected = (
            PreviewRenderer(each).draw(*SPHERE, camera, SIZE, look) for each in (live, uploaded)
        )
        assert expected[..., :3].max() > 0.1
        # Half floats of what is uploaded, whose differences lobes magnify: as of `principled_radiance`
        assert np.abs(found - expected).max() < 2e-3 * expected.max()


def test_filtering_leaves_blender_s_state_alone() -> None:
    ensure_context()
    gpu.state.blend_set("ALPHA")
    try:
        show(GpuLivePyramid(FACE, families()), random_faces(FACE))
        assert gpu.state.blend_get() == "ALPHA"
    finally:
        gpu.state.blend_set("NONE")
