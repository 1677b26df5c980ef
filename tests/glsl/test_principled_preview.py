"""Pictures of Principled materials against core/kinds/kernel_pyramid/shading.py at every sample."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf.principled import Surface
from rsibr.rsibr_addon.core.geometry.camera import Camera
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.shading import principled_radiance
from rsibr.rsibr_addon.device.context import ensure_context
from rsibr.rsibr_addon.device.kinds.kernel_pyramid import GpuPyramid
from rsibr.rsibr_addon.device.preview import PreviewRenderer
from rsibr.tests.glsl.principled_inputs import families, pyramid
from rsibr.tests.glsl.test_preview_renderer import BY_CAMERA, SIZE, SPHERE, reference_pixels

SURFACES = {
    "default": Surface(),
    "metal": Surface(base_color=(0.9, 0.6, 0.3), metallic=1.0, roughness=0.4, specular_tint=(0.5, 0.7, 1.0)),
    "clay": Surface(base_color=(0.7, 0.5, 0.4), specular_level=0.0, diffuse_roughness=0.8, alpha=0.6),
    "coated": Surface(
        base_color=(0.5, 0.2, 0.1),
        ior=1.8,
        metallic=0.4,
        roughness=0.7,
        coat_weight=0.8,
        coat_roughness=0.3,
        coat_ior=1.3,
        coat_tint=(0.6, 0.8, 1.0),
        emission=(0.0, 0.1, 0.2),
    ),
    "cloth": Surface(
        base_color=(0.5, 0.1, 0.2), sheen_weight=0.8, sheen_roughness=0.3, sheen_tint=(1.0, 0.6, 0.3)
    ),
}


@pytest.fixture(scope="module")
def renderer() -> PreviewRenderer:
    ensure_context()
    return PreviewRenderer(GpuPyramid(pyramid(), families()))


@BY_CAMERA
@pytest.mark.parametrize("name", SURFACES)
def test_a_picture_is_what_the_reference_says(name: str, camera: Camera, renderer: PreviewRenderer) -> None:
    surface = SURFACES[name]

    def shade(normal: np.ndarray, view_dir: np.ndarray, _: np.ndarray) -> np.ndarray:
        flat = normal.reshape(-1, 3), view_dir.reshape(-1, 3)
        return principled_radiance(pyramid(), families(), surface, *flat).reshape(normal.shape)

    expected, inside = reference_pixels(camera, shade)
    picture = renderer.draw(*SPHERE, camera, SIZE, surface)
    np.testing.assert_allclose(picture[inside, 3], surface.alpha, rtol=1e-6)
    assert np.count_nonzero(inside) > 0.6 * SIZE**2
    # Half floats keep 11 bits, and lobes are sums of kernels with up to 8 times their magnitude; facets turn
    # mirror directions by 4e-4; weights of texels may be rounded to 8 bits.
    assert np.abs(picture[..., :3] - expected)[inside].max() < 2e-3 * expected.max()
