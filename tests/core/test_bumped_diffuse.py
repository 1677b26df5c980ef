"""The cosine that a bumped normal leaves, against integrals over all directions."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf.bumped_diffuse import bumped_cosine, shadowing

COUNT = 400
COSINE, AZIMUTH = np.meshgrid(
    (np.arange(COUNT) + 0.5) / COUNT, np.pi * (np.arange(2 * COUNT) + 0.5) / COUNT, indexing="ij"
)
SINE = np.sqrt(1.0 - COSINE**2)
LIGHT = np.stack([SINE * np.cos(AZIMUTH), SINE * np.sin(AZIMUTH), COSINE], axis=-1)
"""Directions above the normal, the Z axis, each of the same solid angle."""
UP = np.array([0.0, 0.0, 1.0])


@pytest.mark.parametrize("degrees", [0.5, 5.0, 15.0, 30.0, 50.0, 65.0])
def test_it_has_the_share_and_the_direction_of_the_integral(degrees: float) -> None:
    lean = np.radians(degrees)
    smooth = np.array([np.sin(lean), 0.0, np.cos(lean)])
    left = 2.0 * COSINE * shadowing(UP, smooth, LIGHT)
    mean = (LIGHT * left[..., None]).mean(axis=(0, 1))
    axis, share = bumped_cosine(UP, smooth)
    assert abs(share - left.mean()) < 6e-3
    apart = np.linalg.norm(np.cross(axis, mean / np.linalg.norm(mean)))
    assert apart < np.radians(1.0)


def test_what_is_not_bumped_stays() -> None:
    normal = np.array([[0.6, 0.0, 0.8], [0.0, 0.0, -1.0]])
    axis, share = bumped_cosine(normal, normal)
    np.testing.assert_allclose(axis, normal, atol=1e-7)
    np.testing.assert_allclose(share, 1.0, atol=1e-7)


def test_normals_that_lean_far_hide_as_facets_of_width_one() -> None:
    smooth = np.array([np.sin(1.4), 0.0, np.cos(1.4)])
    rise = np.linspace(0.05, 1.0, 20)
    light = np.cross(smooth, (0.0, 1.0, 0.0)) * np.sqrt(1.0 - rise**2)[:, None] + rise[:, None] * smooth
    # Smith's masking of GGX with alpha 1 is 2 c / (1 + c), c being the cosine to the light
    np.testing.assert_allclose(shadowing(UP, smooth, light), 2.0 * rise / (1.0 + rise), rtol=1e-12)


def test_light_from_below_the_surface_is_hidden() -> None:
    smooth = np.array([0.6, 0.0, 0.8])
    factor = shadowing(UP, smooth, LIGHT)
    assert np.all(factor[LIGHT @ smooth <= 0.0] == 0.0)
    assert factor.max() > 0.99
