"""The white furnace against albedos known in closed form."""

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.host.furnace import COSINES, directional_albedo
from rsibr.rsibr_addon.host.materials import load_material
from rsibr.rsibr_addon.host.scenes import temporary_scene

pytestmark = pytest.mark.needs("cycles")

COSINE = (np.arange(COSINES) + 0.5) / COSINES


def albedo_of(preset: str) -> np.ndarray:
    with temporary_scene() as scene:
        return directional_albedo(scene, load_material(preset), seed=0)


def fresnel_dielectric(cosine: np.ndarray, index: float) -> np.ndarray:
    """Unpolarised reflectance of a smooth surface."""
    inside = np.sqrt(1.0 - (1.0 - cosine**2) / index**2)
    across = (cosine - index * inside) / (cosine + index * inside)
    along = (inside - index * cosine) / (inside + index * cosine)
    return 0.5 * (across**2 + along**2)


def test_a_mirror_returns_all_light_from_every_side() -> None:
    before = {repr(item) for item in bpy.data.all_ids}
    found = albedo_of("mirror")
    assert found.shape == (2, COSINES, 3)
    assert found.dtype == np.float32
    np.testing.assert_allclose(found[1], 1.0, atol=1e-5)
    np.testing.assert_allclose(found[0], 0.0, atol=1e-5)
    assert {repr(item) for item in bpy.data.all_ids} == before


def test_lambert_returns_its_colour_to_every_side() -> None:
    found = albedo_of("clay")
    # A million samples a cosine leave a few parts in a thousand.
    np.testing.assert_allclose(found[0], np.broadcast_to((0.55, 0.40, 0.30), (COSINES, 3)), rtol=0.02)
    np.testing.assert_allclose(found[1], 0.0, atol=1e-5)


def test_each_tile_stands_at_its_own_angle() -> None:
    found = albedo_of("ceramic")
    # A surface of alpha .01 is nearly smooth, away from grazing angles, where its facets' slopes count.
    # Face on, one sample in ten takes the coat, at most: 1e6 / 10 hits of equal weight are known to 0.3 %,
    # and other weights, and the most of 150 numbers, to some times that.
    clear = COSINE > 0.2
    expected = fresnel_dielectric(COSINE, 1.5)[clear]
    np.testing.assert_allclose(found[1, clear], np.repeat(expected[:, None], 3, axis=1), rtol=0.03)
    # What the coat reflects does not reach the base.
    assert np.all(np.diff(found[0, :, 0][clear][::8]) > 0.0)
