"""Our Principled BSDF against Cycles' own, in a white furnace."""

import dataclasses

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf.albedo import directional_albedo as integrated
from rsibr.rsibr_addon.core.brdf.principled import Principled
from rsibr.rsibr_addon.host.furnace import COSINES, directional_albedo
from rsibr.rsibr_addon.host.scenes import temporary_scene
from rsibr.rsibr_addon.host.surfaces import INPUTS

pytestmark = pytest.mark.needs("cycles")

SHOWN = [3, 15, 31, 63]
"""Rows of the furnace: 87 to 7 degrees from the normal."""


@pytest.mark.slow
@pytest.mark.parametrize(
    "material",
    [
        Principled(base_color=(0.9, 0.5, 0.2), metallic=1.0, roughness=0.8, specular_tint=(0.5, 0.8, 1.0)),
        Principled(base_color=(0.8, 0.5, 0.2), roughness=0.4, ior=1.8, specular_tint=(1.0, 0.5, 0.2)),
        Principled(base_color=(0.9, 0.5, 0.2), diffuse_roughness=0.5, specular_level=0.8),
        Principled(
            base_color=(0.9, 0.5, 0.2),
            metallic=0.5,
            coat_weight=0.7,
            coat_roughness=0.3,
            coat_ior=1.7,
            coat_tint=(0.5, 0.8, 1.0),
        ),
        Principled(
            base_color=(0.9, 0.5, 0.2),
            sheen_weight=0.8,
            sheen_roughness=0.3,
            sheen_tint=(0.5, 0.8, 1.0),
        ),
    ],
    ids=["metal", "plastic", "rough", "coated", "cloth"],
)
def test_it_sends_back_what_cycles_does(material: Principled) -> None:
    cosine = (np.array(SHOWN) + 0.5) / COSINES
    with temporary_scene() as scene:
        made = bpy.data.materials.new("material")
        nodes = made.node_tree.nodes
        (node,) = (each for each in nodes if each.bl_idname == "ShaderNodeBsdfPrincipled")
        for field in dataclasses.fields(material):
            value = getattr(material, field.name)
            node.inputs[INPUTS[field.name]].default_value = (
                (*value, 1.0) if isinstance(value, tuple) else value
            )
        shown = directional_albedo(scene, made, seed=1).sum(axis=0)[SHOWN]
    # Cycles' tables have 16 to 32 steps along each axis, ours 33; its samples leave some tenths of a percent
    np.testing.assert_allclose(integrated(material, cosine), shown, rtol=0.015)
