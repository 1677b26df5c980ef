"""The split sum as a family of lobes, against its own definition."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf.principled import Surface
from rsibr.rsibr_addon.core.geometry.directions import reflect
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.bake import bake_pyramid
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.shading import principled_radiance
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.split_sum import split_families
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.files.kinds.kernel_pyramid import shipped_families
from rsibr.tests.engine_light import sky, truth

WHITE = np.ones(3)


@pytest.mark.slow
def test_a_white_metal_shows_light_filtered_about_the_mirror_direction() -> None:
    """Its albedo is 1, as light that bounces between facets is added.

    Sums of 12 kernels are within 1 % of GGX's filter, and of its kink at the horizon within 2 %.
    """
    rng = np.random.default_rng(5)
    normal, view_dir = rng.normal(size=(2, 50, 3))
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    view_dir /= np.linalg.norm(view_dir, axis=1, keepdims=True)
    view_dir *= np.where(np.einsum("ij,ij->i", normal, view_dir) < 0.0, -1.0, 1.0)[:, None]
    pyramid = drain(bake_pyramid(sky(), 128)).pyramid
    for roughness, close in ((0.3, 0.01), (0.5, 0.01), (1.0, 0.02)):
        surface = Surface(base_color=WHITE, metallic=np.array(1.0), roughness=np.array(roughness))
        shown = principled_radiance(pyramid, split_families(shipped_families()), surface, normal, view_dir)
        wanted = truth(reflect(view_dir, normal), roughness)
        assert np.sqrt(np.mean((shown - wanted) ** 2) / np.mean(wanted**2)) < close, roughness
