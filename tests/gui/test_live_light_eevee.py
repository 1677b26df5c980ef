"""Live light takes the radiance that EEVEE shades with, and notices how a viewport shows a scene."""

from collections.abc import Callable

import numpy as np
from rsibr.tests.gui.test_live_light import PRELUDE

Told = Callable[[str], dict]

WORLD = np.array([0.6, 0.3, 0.15])

STAGE = """
WORLD = (1.0, 0.5, 0.25, 1.0)

def matte():
    material = bpy.data.materials.new("Matte")
    nodes, links = material.node_tree.nodes, material.node_tree.links
    shader = nodes.new("ShaderNodeBsdfDiffuse")
    shader.inputs["Color"].default_value = (0.5, 0.5, 0.5, 1.0)
    output = next(node for node in nodes if node.type == "OUTPUT_MATERIAL")
    links.new(shader.outputs[0], output.inputs["Surface"])
    return material

def stage():
    # A wall behind the cube, of albedo 0.5, on which a sun shines at 45 degrees; a black world
    bpy.data.objects.remove(bpy.data.objects["Light"])
    walls = room([(1, 1, 1)] * 6)
    wall = walls.pop(1)
    for other in walls:
        bpy.data.objects.remove(other)
    wall.data.materials.append(matte())
    sun = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
    scene = bpy.context.scene
    scene.collection.objects.link(sun)
    sun.matrix_world = Vector((1, 0, 1)).to_track_quat("Z", "Y").to_matrix().to_4x4()
    sun.data.energy, sun.data.angle = 2.0, 0.0
    world = scene.world.node_tree.nodes["Background"].inputs
    world["Color"].default_value, world["Strength"].default_value = WORLD, 0.0
    scene.eevee.taa_samples = 1
    return wall, sun, world

def radiances():
    # Of the middle of each face
    size = only_light().gpu_map_set.size
    strip = np.array(only_light().gpu_map_set._faces.texture.read()).reshape(size, 6, size, 4)
    middle = slice(size // 2 - 2, size // 2 + 2)
    return strip[middle, :, middle, :3].mean(axis=(0, 2)).tolist()

def seen():
    yield from drawn()
    return radiances()
"""

RENDERED = """
def scenario(told):
    cube = mirror()
    wall, sun, world = stage()
    yield from drawn()
    among = own()
    told["own"] = int(among.sum())
    shading = view().spaces.active.shading
    shading.type = "RENDERED"
    cube.rsibr.live.on = True
    told["sun"] = yield from seen()
    sun.data.energy = 4.0
    told["brighter sun"] = yield from seen()
    world["Strength"].default_value = 0.6
    told["world"] = yield from seen()
    shading.use_scene_lights_render = False
    told["no lamps"] = yield from seen()
    bpy.data.objects.remove(wall)
    yield from drawn()
    told["not the world's"] = others((203, 149, 108), among)
    # Its own material in the dark, but for the sun itself, at 45 degrees to the top
    cube.rsibr.live.mips = False
    inputs = cube.active_material.node_tree.nodes["Principled BSDF"].inputs
    inputs["Base Color"].default_value, inputs["Specular IOR Level"].default_value = (0.5, 0.5, 0.5, 1.0), 0.0
    world["Strength"].default_value, shading.use_scene_lights_render = 0.0, True
    yield from drawn()
    x, y = location_3d_to_region_2d(region(view()), view().spaces.active.region_3d, Vector((0, 0, 1)))
    told["in the sun"] = pixels()[int(y), int(x)].tolist()
    told["faults"] = [previews.faults.message(cube), previews.faults.trouble]
"""


def test_a_lamp_s_and_the_world_s_light_are_mirrored(told: Told) -> None:
    answer = told(PRELUDE + STAGE + RENDERED)
    wall = np.eye(6)[:, 1:2]
    # Albedo times irradiance over pi; EEVEE draws into half floats, 11 bits
    lit = 0.5 * 2.0 * np.sqrt(0.5) / np.pi * wall * np.ones(3)
    np.testing.assert_allclose(answer["sun"], lit, rtol=2e-3)
    np.testing.assert_allclose(answer["brighter sun"], 2.0 * lit, rtol=2e-3)
    # EEVEE lights diffuse surfaces with a world of order 1 on a coarse grid: seen to lack 0.5 %
    np.testing.assert_allclose(answer["world"], 2.0 * lit + (1.0 - 0.5 * wall) * WORLD, rtol=0.02)
    np.testing.assert_allclose(answer["no lamps"], (1.0 - 0.5 * wall) * WORLD, rtol=0.02)
    assert answer["own"] > 2000
    assert answer["not the world's"] == 0
    # A diffuse surface of albedo .5, as sRGB encodes it
    shown = 0.5 * 4.0 * np.sqrt(0.5) / np.pi
    expected = 255.0 * (1.055 * shown ** (1.0 / 2.4) - 0.055)
    np.testing.assert_allclose(answer["in the sun"], [expected] * 3, atol=3.0)
    assert answer["faults"] == [None, None]


NOTICED = """
def scenario(told):
    cube = mirror()
    wall, sun, world = stage()
    world["Strength"].default_value = 0.6
    shading = view().spaces.active.shading
    shading.type, cube.rsibr.live.on = "MATERIAL", True
    updates = []
    bpy.app.handlers.depsgraph_update_post.append(lambda *_: previews.is_hiding or updates.append(0))
    told["at first"] = yield from seen()
    updates.clear()
    for name, value in (
        ("studiolight_background_alpha", 1.0),
        ("studiolight_background_blur", 0.0),
        ("studiolight_intensity", 2.0),
        ("studiolight_rotate_z", 1.0),
        ("studio_light", "sunset.exr"),
        ("use_scene_lights", True),
        ("use_scene_world", True),
    ):
        setattr(shading, name, value)
        told[name] = yield from seen()
    shading.type = "SOLID"
    told["solid"] = yield from seen()
    shading.color_type, shading.single_color = "SINGLE", (0.1, 0.2, 0.3)
    told["single colour"] = yield from seen()
    told["updates"] = len(updates)
"""


def test_other_settings_of_the_viewport_s_shading_are_noticed(told: Told) -> None:
    answer = told(PRELUDE + STAGE + NOTICED)
    # It was never the scene that changed
    assert answer.pop("updates") == 0
    seen = {name: np.array(radiances) for name, radiances in answer.items()}
    sky, wall = [0, 2, 3, 4, 5], 1
    # Half floats once more; the light of a studio comes without the world
    alpha, blur = seen["studiolight_background_alpha"], seen["studiolight_background_blur"]
    assert np.all(np.ptp(seen["at first"][sky], axis=0) < 1e-3)
    assert np.all(np.ptp(alpha[sky], axis=0) > 0.05)
    assert not np.allclose(alpha, blur, rtol=0.02)
    np.testing.assert_allclose(seen["studiolight_intensity"], 2.0 * blur, rtol=4e-3)
    turned = seen["studiolight_rotate_z"]
    assert not np.allclose(turned[[0, 2, 3]], 2.0 * blur[[0, 2, 3]], rtol=0.1)
    assert not np.allclose(seen["studio_light"], turned, rtol=0.1)
    lamps = seen["use_scene_lights"]
    np.testing.assert_allclose(lamps[sky], seen["studio_light"][sky], rtol=4e-3)
    assert np.all(lamps[wall] > seen["studio_light"][wall] + 0.2)
    np.testing.assert_allclose(seen["use_scene_world"][sky], np.tile(WORLD, (5, 1)), rtol=2e-3)
    np.testing.assert_allclose(seen["solid"][wall], 1.0, rtol=2e-3)
    np.testing.assert_allclose(seen["single colour"][wall], (0.1, 0.2, 0.3), rtol=2e-3)
