"""Mirrors drawn on the GPU against core/kinds/environment.py at every sample."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.environment import Environment
from rsibr.rsibr_addon.core.geometry.camera import Camera
from rsibr.rsibr_addon.core.kinds.environment import EnvironmentLook, mirrored_environment
from rsibr.rsibr_addon.core.maps import equirect
from rsibr.rsibr_addon.device.context import ensure_context
from rsibr.rsibr_addon.device.kinds.environment import GpuEnvironment, environment_shader
from rsibr.rsibr_addon.device.preview import PreviewRenderer
from rsibr.tests.glsl.test_preview_renderer import BY_CAMERA, SIZE, SPHERE, reference_pixels
from rsibr.tests.mirror_capture import environment


@pytest.mark.parametrize("antialiased", [False, True])
@BY_CAMERA
def test_a_picture_is_what_the_reference_says(antialiased: bool, camera: Camera) -> None:
    ensure_context()
    light, look = environment(), EnvironmentLook((0.2, 0.6, 1.0), antialiased)
    picture = PreviewRenderer(GpuEnvironment(light)).draw(*SPHERE, camera, SIZE, look)
    expected, inside = reference_pixels(
        camera, lambda normal, view_dir, seen: mirrored_environment(light, normal, view_dir, look, seen), 0.3
    )
    assert np.count_nonzero(inside) > 0.5 * SIZE**2
    # Facets turn mirror directions by up to 4e-4, radiance changes by up to 1.7 a radian.
    assert np.abs(picture[..., :3] - expected)[inside].max() < 2e-3 * expected[inside].max()
    assert expected[inside].std() > 0.05


def test_a_small_lamp_neither_goes_out_nor_flickers() -> None:
    ensure_context()
    height = 128
    solid_angle = equirect.texel_solid_angle(2 * height, height)[70:73, :3].sum()
    found: dict[bool, list[float]] = {False: [], True: []}
    for turn in range(8):
        radiance = np.full((height, 2 * height, 3), 1e-3, dtype=np.float32)
        radiance[70:73, height + 20 + turn : height + 23 + turn] = 1e4
        renderer = PreviewRenderer(GpuEnvironment(Environment(radiance, "lamp")))
        for antialiased, energy in found.items():
            picture = renderer.draw(
                *SPHERE, Camera((1.0, 0.0, 0.0)), 8, EnvironmentLook(antialiased=antialiased)
            )
            energy.append(float(picture[..., 0].sum()))
    # A mirror ball scatters evenly: of its disk, solid angle / 4 shows the lamp, in pixels of 1/16.
    expected = 1e4 * solid_angle / 4.0 * 16.0
    assert min(found[False]) < 0.01 * expected
    assert max(found[False]) > 2.0 * expected
    # As of antialiased tables: boxes hold some of a sample's neighbours.
    np.testing.assert_allclose(found[True], expected, rtol=0.15)


def test_the_program_is_built_once() -> None:
    ensure_context()
    assert environment_shader() is environment_shader()
