"""A mirrored ball in a box room, as Cycles renders it, from a map that was captured beside it."""

from dataclasses import replace
from pathlib import Path

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.geometry.camera import Camera
from rsibr.rsibr_addon.core.geometry.near_room import Room
from rsibr.rsibr_addon.core.kinds.mip_chain.chain import MipChain
from rsibr.rsibr_addon.core.kinds.mip_chain.lobe_mips import environment_faces
from rsibr.rsibr_addon.core.kinds.mip_chain.shading import MipLook, mip_chain_radiance
from rsibr.rsibr_addon.core.maps import sphere_map
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.files.radiance_pictures import read_radiance
from rsibr.rsibr_addon.host.cameras import add_camera
from rsibr.rsibr_addon.host.rendering import configure_cycles, render_passes
from rsibr.rsibr_addon.host.spheres import add_sphere
from rsibr.rsibr_addon.settings.environment import SceneLight
from rsibr.rsibr_addon.tasks.light.scene import illuminate_from_scene
from rsibr.tests.cycles.test_reflection_tables import shader

pytestmark = [pytest.mark.needs("cycles"), pytest.mark.slow]

SIZE, FINE = 32, 128
WIDTHS, MIDDLE, CAPTURED_AT = (5.0, 4.6, 4.4), (0.2, 0.1, -0.1), (0.5, -0.4, 0.3)
CAMERA = Camera((0.5, -0.7, 0.4))


def add_walls(scene: bpy.types.Scene) -> None:
    """A box whose walls shine, in colours that change along them."""
    material = bpy.data.materials.new("walls")
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    place, wave = nodes.new("ShaderNodeNewGeometry"), nodes.new("ShaderNodeVectorMath")
    shine, output = nodes.new("ShaderNodeEmission"), nodes.new("ShaderNodeOutputMaterial")
    wave.operation = "MULTIPLY_ADD"
    wave.inputs[1].default_value, wave.inputs[2].default_value = (0.15,) * 3, (0.5,) * 3
    links.new(place.outputs["Position"], wave.inputs[0])
    links.new(wave.outputs["Vector"], shine.inputs["Color"])
    links.new(shine.outputs["Emission"], output.inputs["Surface"])
    bpy.ops.mesh.primitive_cube_add(size=1.0, location=MIDDLE, scale=WIDTHS)
    bpy.context.object.data.materials.append(material)


def test_a_ball_in_a_room_is_a_third_as_wrong_as_in_distant_light(tmp_path: Path) -> None:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    add_walls(scene)
    light = SceneLight(size=512, samples=1, point=CAPTURED_AT)
    radiance = read_radiance(drain(illuminate_from_scene(light, tmp_path / "light.exr")))
    add_sphere(scene, shader("Glossy", Roughness=0.0))
    add_camera(scene, CAMERA)
    configure_cycles(scene, SIZE, SIZE, 64)
    scene.cycles.max_bounces = scene.cycles.glossy_bounces = 1
    scene.view_settings.view_transform = "Standard"
    reference = render_passes(scene)["Combined"][..., :3]
    chain = MipChain((environment_faces(radiance, 128).astype(np.float32),), np.zeros((9, 3)))
    normal = sphere_map.normal_from_uv(texel_centres(FINE, FINE)) @ CAMERA.frame.T
    near = MipLook(
        f0=(1.0, 1.0, 1.0), room=Room.BOX, room_size=WIDTHS, room_middle=MIDDLE, captured_at=CAPTURED_AT
    )
    inside = np.linalg.norm(2.0 * texel_centres(SIZE, SIZE) - 1.0, axis=-1) < 0.9

    def error(look: MipLook) -> float:
        shaded = mip_chain_radiance(chain, normal, CAMERA.view_dir, look, position=normal)
        shown = shaded.reshape(SIZE, 4, SIZE, 4, 3).mean(axis=(1, 3))
        return float(np.sqrt(np.mean((shown - reference)[inside] ** 2)))

    assert error(near) < error(replace(near, room=Room.DISTANT)) / 3.0
