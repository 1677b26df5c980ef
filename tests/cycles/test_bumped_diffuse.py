"""What a bumped normal leaves of diffuse light, beside Cycles."""

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf.bumped_diffuse import bumped_cosine
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.environment import Environment
from rsibr.rsibr_addon.core.filtering.irradiance import irradiance_exact
from rsibr.rsibr_addon.core.geometry.camera import Camera
from rsibr.rsibr_addon.core.maps import equirect
from rsibr.rsibr_addon.host.cameras import add_camera
from rsibr.rsibr_addon.host.cycles import RenderSettings, render_view
from rsibr.rsibr_addon.host.scenes import temporary_scene
from rsibr.rsibr_addon.host.worlds import light_with
from rsibr.tests.synthetic_views import environment_radiance

HEIGHT = 32
UP = np.array([0.0, 0.0, 1.0])
AZIMUTHS = np.radians([20.0, 140.0, 260.0])


def shown_by_cycles(radiance: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """Radiance of a white Lambertian square in the XY plane with another normal, shape (3,)."""
    with temporary_scene() as scene:
        light_with(scene, Environment(radiance, "light"))
        add_camera(scene, Camera(tuple(UP)))
        mesh = bpy.data.meshes.new("square")
        mesh.from_pydata([(-2, -2, 0), (2, -2, 0), (2, 2, 0), (-2, 2, 0)], [], [(0, 1, 2, 3)])
        material = bpy.data.materials.new("square")
        nodes, links = material.node_tree.nodes, material.node_tree.links
        (output,) = (each for each in nodes if each.type == "OUTPUT_MATERIAL")
        diffuse, bent = nodes.new("ShaderNodeBsdfDiffuse"), nodes.new("ShaderNodeCombineXYZ")
        diffuse.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
        for socket, value in zip(bent.inputs, normal, strict=True):
            socket.default_value = value
        links.new(bent.outputs[0], diffuse.inputs["Normal"])
        links.new(diffuse.outputs[0], output.inputs["Surface"])
        mesh.materials.append(material)
        scene.collection.objects.link(bpy.data.objects.new("square", mesh))
        view = render_view(scene, RenderSettings(8, 4096))
    return (view.diffuse + view.glossy).mean(axis=(0, 1), dtype=np.float64)


@pytest.mark.slow
@pytest.mark.parametrize("degrees", [15.0, 40.0, 65.0])
def test_it_is_what_cycles_leaves(degrees: float) -> None:
    radiance = environment_radiance(equirect.direction_from_uv(texel_centres(2 * HEIGHT, HEIGHT)))
    lean = np.radians(degrees)
    across = np.stack([np.cos(AZIMUTHS), np.sin(AZIMUTHS)], axis=-1)
    normals = np.concatenate([np.sin(lean) * across, np.full((3, 1), np.cos(lean))], axis=1)
    truth = np.stack([shown_by_cycles(radiance, normal) for normal in normals])
    axis, share = bumped_cosine(normals, UP)
    ours = share[:, None] * irradiance_exact(radiance, axis) / np.pi
    plain = irradiance_exact(radiance, normals) / np.pi
    error, before = (np.linalg.norm(each - truth) / np.linalg.norm(truth) for each in (ours, plain))
    # A cosine is broader than what is left of a normal that leans far
    assert error < 0.06
    assert error < 0.3 * before
