"""A mirrored ball in a box room, as Cycles renders it, from a map that was captured beside it."""

from dataclasses import replace
from pathlib import Path

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.geometry.camera import Camera
from rsibr.rsibr_addon.core.geometry.near_room import Room
from rsibr.rsibr_addon.core.kinds.live_environment import chain_of_faces
from rsibr.rsibr_addon.core.kinds.mip_chain.chain import MipChain
from rsibr.rsibr_addon.core.kinds.mip_chain.lobe_mips import environment_faces
from rsibr.rsibr_addon.core.kinds.mip_chain.shading import MipLook, mip_chain_radiance
from rsibr.rsibr_addon.core.kinds.mip_chain.texture_space import tent_halved
from rsibr.rsibr_addon.core.maps import sphere_map
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.files.radiance_pictures import read_radiance
from rsibr.rsibr_addon.host.cameras import add_camera
from rsibr.rsibr_addon.host.rendering import configure_cycles, render_passes
from rsibr.rsibr_addon.host.spheres import add_sphere
from rsibr.rsibr_addon.settings.environment import SceneLight
from rsibr.rsibr_addon.tasks.light.scene import illuminate_from_scene
from rsibr.tests.cycles import joined_rooms
from rsibr.tests.cycles.test_reflection_tables import shader

pytestmark = [pytest.mark.needs("cycles"), pytest.mark.slow]

WIDTHS, MIDDLE, CAPTURED_AT = (5.0, 4.6, 4.4), (0.2, 0.1, -0.1), (0.5, -0.4, 0.3)
CAMERA = Camera((0.5, -0.7, 0.4))


def add_walls() -> None:
    """A box whose walls shine, in colours that change along them."""
    bpy.ops.mesh.primitive_cube_add(size=1.0, location=MIDDLE, scale=WIDTHS)
    bpy.context.object.data.materials.append(joined_rooms.shining((0.5,) * 3, (0.15,) * 3))


@pytest.fixture
def chain(tmp_path: Path) -> MipChain:
    """The room, with a point in it captured, and room for a ball."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    add_walls()
    light = SceneLight(size=512, samples=1, point=CAPTURED_AT)
    radiance = read_radiance(drain(illuminate_from_scene(light, tmp_path / "light.exr")))
    return chain_of_faces(environment_faces(radiance, 128).astype(np.float32), tent_halved)


def rendered(material: bpy.types.Material, size: int, samples: int) -> np.ndarray:
    """A ball in the room by Cycles, lit by the walls alone."""
    scene = bpy.context.scene
    add_sphere(scene, material)
    add_camera(scene, CAMERA)
    configure_cycles(scene, size, size, samples)
    cycles = scene.cycles
    cycles.max_bounces = cycles.glossy_bounces = cycles.diffuse_bounces = 1
    scene.view_settings.view_transform = "Standard"
    return render_passes(scene)["Combined"][..., :3]


@pytest.mark.parametrize(
    ("material", "colours", "size", "samples"),
    [
        (("Glossy", {"Roughness": 0.0}), {"f0": (1.0,) * 3, "kd": (0.0,) * 3}, 32, 64),
        # By hemispheres full of light, whose noise so many samples make less than a fifth of the error
        (("Diffuse", {}), {"f0": (0.0,) * 3, "kd": (1.0,) * 3}, 16, 1024),
    ],
    ids=["mirror", "diffuse"],
)
def test_a_ball_in_a_room_is_a_third_as_wrong_as_in_distant_light(
    chain: MipChain, material: tuple, colours: dict, size: int, samples: int
) -> None:
    name, inputs = material
    reference = rendered(shader(name, **inputs), size, samples)
    normal = sphere_map.normal_from_uv(texel_centres(4 * size, 4 * size)) @ CAMERA.frame.T
    # Without the outline, where Schlick's term has the diffuse ball mirror
    inside = np.linalg.norm(2.0 * texel_centres(size, size) - 1.0, axis=-1) < 0.9
    near = MipLook(**colours, room=Room.BOX, room_size=WIDTHS, room_middle=MIDDLE, captured_at=CAPTURED_AT)

    def error(look: MipLook) -> float:
        shaded = mip_chain_radiance(chain, normal, CAMERA.view_dir, look, position=normal)
        shown = shaded.reshape(size, 4, size, 4, 3).mean(axis=(1, 3))
        return float(np.sqrt(np.mean((shown - reference)[inside] ** 2)))

    assert error(near) < error(replace(near, room=Room.DISTANT)) / 3.0


def test_a_ball_in_a_door_is_nearest_to_the_truth_from_both_rooms_probes(tmp_path: Path) -> None:
    joined_rooms.add_rooms()
    chain = joined_rooms.rooms_chain(tmp_path, 32, 0.5)
    mirror, look = shader("Glossy", Roughness=0.0), MipLook(f0=(1.0,) * 3, kd=(0.0,) * 3)
    error = joined_rooms.errors(chain, mirror, look, (-0.5, 0.0, 0.5), 12, 16)
    assert error["blended"] < 0.75 * error["nearest"]
    assert error["nearest"] < 0.75 * error["one"]
