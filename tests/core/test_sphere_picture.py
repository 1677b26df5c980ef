"""A sphere as pixels see it."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.pictures.sphere import sphere_pixels

VIEW_DIR = (0.3, -1.0, 0.35)


@pytest.mark.parametrize("size", [16, 33])
def test_it_fills_the_picture(size: int) -> None:
    pixels = sphere_pixels(size, VIEW_DIR)
    covered = pixels.picture(np.ones(pixels.normal.shape))[..., 3]
    # Along the rim a pixel counts as if a straight edge faced it: up to 1 - 1/sqrt(2) off, both ways
    assert covered.sum() == pytest.approx(0.25 * np.pi * size**2, rel=2e-3)
    assert covered[size // 2, size // 2] == 1.0
    assert not covered[0, 0]


def test_normals_are_the_sphere_s() -> None:
    pixels = sphere_pixels(64, VIEW_DIR)
    towards = np.array(VIEW_DIR) / np.linalg.norm(VIEW_DIR)
    np.testing.assert_allclose(np.linalg.norm(pixels.normal, axis=1), 1.0)
    assert (pixels.normal @ towards).min() > 0.0
    normal = pixels.picture(pixels.normal)[..., :3]
    # Row 0 is at the bottom, and the frame is upright
    up = np.cross(towards, np.cross((0.0, 0.0, 1.0), towards))
    assert normal[62, 32] @ up > 0.85 > -0.85 > normal[1, 32] @ up
    np.testing.assert_allclose(normal[31:33, 31:33].mean(axis=(0, 1)), towards, atol=1e-3)
    right = np.cross((0.0, 0.0, 1.0), towards)
    assert normal[32, 62] @ right > 0.9
