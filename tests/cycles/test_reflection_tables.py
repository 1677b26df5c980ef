"""Each table shows what Cycles shows of the surface that it stands for."""

from dataclasses import replace

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.core.antialiased.footprint import pixel_footprints
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.geometry.camera import Camera
from rsibr.rsibr_addon.core.geometry.directions import reflect
from rsibr.rsibr_addon.core.kinds.environment import EnvironmentLook, mirrored_environment
from rsibr.rsibr_addon.core.kinds.reflection_tables.bake import TableSizes, bake_tables
from rsibr.rsibr_addon.core.kinds.reflection_tables.material import material_from_texts
from rsibr.rsibr_addon.core.kinds.reflection_tables.shading import TablesLook, reflect_tables
from rsibr.rsibr_addon.core.maps import sphere_map
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.files.brdfs import read_measured
from rsibr.rsibr_addon.host.cameras import add_camera
from rsibr.rsibr_addon.host.cycles import RenderSettings, render_view
from rsibr.rsibr_addon.host.scenes import temporary_scene
from rsibr.rsibr_addon.host.spheres import add_sphere
from rsibr.rsibr_addon.host.worlds import light_with
from rsibr.tests.mirror_capture import environment

SIZE, FINE = 24, 96
CAMERA = Camera((0.8, -1.0, 0.6))


def shader(kind: str, **values: float) -> bpy.types.Material:
    material = bpy.data.materials.new(kind)
    nodes = material.node_tree.nodes
    nodes.clear()
    surface, output = nodes.new(f"ShaderNodeBsdf{kind}"), nodes.new("ShaderNodeOutputMaterial")
    material.node_tree.links.new(surface.outputs["BSDF"], output.inputs["Surface"])
    surface.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    for name, value in values.items():
        surface.inputs[name].default_value = value
    return material


def rendered(material: bpy.types.Material, samples: int) -> tuple[np.ndarray, float]:
    """Radiance of the sphere, shape (SIZE, SIZE, 3), and its relative noise."""
    with temporary_scene() as scene:
        light_with(scene, environment())
        add_sphere(scene, material)
        add_camera(scene, CAMERA)
        view = render_view(scene, RenderSettings(SIZE, samples))
    return view.rgba[..., :3], view.noise


def shown_from(**texts: str) -> np.ndarray:
    """The same from reflection tables that all count in full at every angle."""
    baked = drain(
        bake_tables(environment().radiance, material_from_texts(texts, read_measured), TableSizes())
    )
    tables = replace(baked.tables, weights=np.ones_like(baked.tables.weights))
    normal = sphere_map.normal_from_uv(texel_centres(FINE, FINE)) @ CAMERA.frame.T
    radiance = reflect_tables(tables, normal, CAMERA.view_dir, TablesLook())
    return radiance.reshape(SIZE, 4, SIZE, 4, 3).mean(axis=(1, 3))


@pytest.mark.parametrize(
    ("kind", "values", "samples", "texts"),
    [
        ("Diffuse", {}, 256, {"diffuse": "lambert:kd=1"}),
        ("Glossy", {"Roughness": 0.0}, 64, {"specular": "mirror:"}),
        ("Refraction", {"Roughness": 0.0, "IOR": 1.3}, 64, {"refraction": "clear:eta=1.3"}),
        ("Refraction", {"Roughness": 0.0, "IOR": 0.8}, 64, {"refraction": "clear:eta=0.8"}),
    ],
)
def test_a_table_is_what_cycles_renders(
    kind: str, values: dict[str, float], samples: int, texts: dict[str, str]
) -> None:
    reference, noise = rendered(shader(kind, **values), samples)
    shown = shown_from(**texts)
    sine = np.linalg.norm(2.0 * texel_centres(SIZE, SIZE) - 1.0, axis=-1)
    # Not at the rim, nor at the critical angle, where directions turn without limit.
    inside = sine < 0.9 * min(values.get("IOR", 1.0), 1.0)
    scale = np.sqrt(np.mean(reference[inside] ** 2))
    error = np.abs(shown - reference)[inside]
    # The largest of a thousand values has four standard errors; interpolation between rows of 5 and 3
    # degrees, and a pixel's sixteen samples, err by some thousandths.
    assert error.max() < (4.0 * noise + 0.01) * scale
    assert np.std(shown[inside]) > 0.1 * scale


def test_a_mirror_of_the_environment_is_what_cycles_renders() -> None:
    reference, noise = rendered(shader("Glossy", Roughness=0.0), 64)
    normal = sphere_map.normal_from_uv(texel_centres(FINE, FINE)) @ CAMERA.frame.T
    corners = np.stack(np.meshgrid(*[np.arange(FINE + 1) / FINE] * 2), axis=-1)
    at_corners = sphere_map.normal_from_uv(corners) @ CAMERA.frame.T
    footprint = pixel_footprints(reflect(np.broadcast_to(CAMERA.view_dir, at_corners.shape), at_corners))
    for antialiased in (False, True):
        look = EnvironmentLook(antialiased=antialiased)
        shown = mirrored_environment(environment(), normal, CAMERA.view_dir, look, footprint)
        inside = np.linalg.norm(2.0 * texel_centres(SIZE, SIZE) - 1.0, axis=-1) < 0.9
        error = np.abs(shown.reshape(SIZE, 4, SIZE, 4, 3).mean(axis=(1, 3)) - reference)[inside]
        scale = np.sqrt(np.mean(reference[inside] ** 2))
        # As above; boxes that hold a texel and more blur by up to its 3 degrees.
        assert error.max() < (4.0 * noise + 0.01) * scale
