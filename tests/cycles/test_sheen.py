"""The table of sheen that comes with us against Cycles' own, and our layers below it."""

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf.albedo import hemisphere_quadrature
from rsibr.rsibr_addon.core.brdf.principled import Surface, layers_of
from rsibr.rsibr_addon.core.brdf.sheen import transformed_cosine
from rsibr.rsibr_addon.core.brdf.sheen_polynomials import sheen_at
from rsibr.rsibr_addon.core.lobes.rings import ROUGHNESSES, elevations, ring_errors, ring_weights
from rsibr.rsibr_addon.files.families import shipped_sheen
from rsibr.rsibr_addon.files.kinds.kernel_pyramid import shipped_families
from rsibr.rsibr_addon.host.furnace import COSINES, directional_albedo
from rsibr.rsibr_addon.host.scenes import temporary_scene
from rsibr.rsibr_addon.host.sheen import measured_sheen

pytestmark = pytest.mark.needs("cycles")


@pytest.mark.parametrize("row", [8, 16])
def test_the_table_comes_out_again(row: int) -> None:
    found = ring_weights(measured_sheen(row / (ROUGHNESSES - 1), elevations()))
    # Cycles computes in single precision, and so does the file
    np.testing.assert_allclose(found, shipped_sheen().weights[row], atol=1e-4)


def test_its_error_is_that_of_the_page() -> None:
    sheen = measured_sheen(0.5, elevations(4))
    errors = ring_errors(sheen, shipped_sheen().at(0.5, sheen.mu))
    assert np.all(errors < 0.22)


@pytest.mark.parametrize("roughness", [0.25, 0.6])
def test_polynomials_are_as_near_as_they_say(roughness: float) -> None:
    sheen = measured_sheen(roughness, np.array([0.004, 0.03, 0.2, 0.6]))
    found = sheen_at(roughness, sheen.mu)
    np.testing.assert_allclose(found.albedo, sheen.albedo, atol=3e-3)
    light_dir, weight = hemisphere_quadrature(0.5)
    for row in np.flatnonzero(sheen.albedo > 0.01):
        values, exact = (
            each.albedo[row] * transformed_cosine(*light_dir.T, each.a[row], each.b[row])
            for each in (found, sheen)
        )
        assert weight @ (values - exact) ** 2 < 0.04**2 * (weight @ exact**2)


@pytest.mark.slow
def test_cloth_sends_back_what_cycles_does() -> None:
    rows = [3, 15, 31, 63]
    cosine = (np.array(rows) + 0.5) / COSINES
    values = {
        "Base Color": (0.5, 0.3, 0.2, 1.0),
        "Sheen Weight": 0.8,
        "Sheen Roughness": 0.6,
        "Sheen Tint": (1.0, 0.5, 0.3, 1.0),
        "Specular IOR Level": 0.0,
    }
    with temporary_scene() as scene:
        made = bpy.data.materials.new("cloth")
        (node,) = (each for each in made.node_tree.nodes if each.bl_idname == "ShaderNodeBsdfPrincipled")
        for name, value in values.items():
            node.inputs[name].default_value = value
        shown = directional_albedo(scene, made, seed=1).sum(axis=0)[rows]
    surface = Surface(
        base_color=(0.5, 0.3, 0.2),
        specular_level=0.0,
        sheen_weight=0.8,
        sheen_roughness=0.6,
        sheen_tint=(1.0, 0.5, 0.3),
    )
    families = shipped_families()
    layers = layers_of(surface, cosine, families)
    reflected = layers.sheen * families.sheen(np.array(0.6), cosine)[:, None]
    # Cycles' samples leave some tenths of a percent
    np.testing.assert_allclose(reflected + layers.diffuse * (0.5, 0.3, 0.2), shown, rtol=0.01)
