"""Previews in Blender's window look as Cycles' renders of the same do."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.files.pictures import write_exr
from rsibr.tests.mirror_capture import environment, write_mirror_capture

Told = Callable[[str], dict]


def prepare(job: Path) -> None:
    """A mirror's map set, and the environment that it was made in."""
    (job / "mirror.rsibr.exr").unlink(missing_ok=True)
    write_mirror_capture(job / "mirror.rsibr.exr", view_count=42, size=128)
    light = environment(256).radiance
    write_exr(job / "light.exr", np.concatenate([light, np.ones_like(light[..., :1])], axis=-1), force=True)


@pytest.fixture(autouse=True)
def _mirror(job: Path) -> None:
    prepare(job)


MIRROR = """
from mathutils import Matrix

LOOKS = ("Standard", "AgX")

def mirror_sphere():
    for item in list(bpy.data.objects):
        bpy.data.objects.remove(item)
    bpy.ops.mesh.primitive_uv_sphere_add(segments=256, ring_count=128)
    sphere = bpy.context.object
    sphere.data.shade_smooth()
    material = bpy.data.materials.new("mirror")
    shader = next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    for name, value in (("Base Color", (1, 1, 1, 1)), ("Metallic", 1.0), ("Roughness", 0.0)):
        shader.inputs[name].default_value = value
    sphere.data.materials.append(material)
    world = bpy.context.scene.world
    texture = world.node_tree.nodes.new("ShaderNodeTexEnvironment")
    texture.image = bpy.data.images.load("/job/light.exr")
    background = next(node for node in world.node_tree.nodes if node.type == "BACKGROUND")
    world.node_tree.links.new(texture.outputs["Color"], background.inputs["Color"])
    return sphere

def turn_world():
    tree = bpy.context.scene.world.node_tree
    mapping, coordinates = (tree.nodes.new(f"ShaderNode{name}") for name in ("Mapping", "TexCoord"))
    mapping.inputs["Rotation"].default_value = (0.4, -0.3, 2.0)
    tree.links.new(coordinates.outputs["Generated"], mapping.inputs["Vector"])
    texture = next(node for node in tree.nodes if node.type == "TEX_ENVIRONMENT")
    tree.links.new(mapping.outputs["Vector"], texture.inputs["Vector"])
    next(node for node in tree.nodes if node.type == "BACKGROUND").inputs["Strength"].default_value = 2.5

def rendered(scene):
    # What Cycles makes of the viewport's own frustum
    part, rv3d = region(view()), view().spaces.active.region_3d
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.collection.objects.link(camera)
    # Blender's parallel views look from the middle of what they show
    scene.camera = camera
    camera.matrix_world = rv3d.view_matrix.inverted() @ Matrix.Translation((0.0, 0.0, 6.0))
    camera.data.type, camera.data.ortho_scale = "ORTHO", 2.0 / rv3d.window_matrix[0][0]
    render = scene.render
    render.engine, scene.cycles.samples, scene.cycles.use_denoising = "CYCLES", 4, False
    scene.cycles.pixel_filter_type = "BOX"
    render.resolution_x, render.resolution_y, render.resolution_percentage = part.width, part.height, 100
    render.dither_intensity, render.film_transparent = 0.0, True
    bpy.ops.render.render()
    pictures = {}
    for look in LOOKS:
        scene.view_settings.view_transform = look
        bpy.data.images["Render Result"].save_render("/job/rendered.png", scene=scene)
        image = bpy.data.images.load("/job/rendered.png")
        image.colorspace_settings.name, image.alpha_mode = "Non-Color", "CHANNEL_PACKED"
        stored = np.empty(part.width * part.height * 4, dtype=np.float32)
        image.pixels.foreach_get(stored)
        bpy.data.images.remove(image)
        pictures[look] = 255.0 * stored.reshape(part.height, part.width, 4)
    bpy.data.objects.remove(camera)
    return pictures

def compare(told, sphere, name):
    # Away from the outline: within 0.95 of the radius, in pixels
    sphere.rsibr.show = False
    pictures = rendered(bpy.context.scene)
    sphere.rsibr.show = True
    part, rv3d = region(view()), view().spaces.active.region_3d
    radius = 0.5 * part.width * rv3d.window_matrix[0][0]
    y, x = np.mgrid[: part.height, : part.width]
    inside = np.hypot(x + 0.5 - 0.5 * part.width, y + 0.5 - 0.5 * part.height) < 0.95 * radius
    for look, picture in pictures.items():
        bpy.context.scene.view_settings.view_transform = look
        yield from drawn()
        yield from drawn()
        error = np.abs(pixels() - picture[..., :3])[inside]
        numbers = np.median(error), np.quantile(error, 0.99), picture[inside].mean()
        told[f"{look}, {name}"] = [float(number) for number in numbers]

def scenario(told):
    bare(view())
    sphere = mirror_sphere()
    sphere.rsibr.map_set = "/job/mirror.rsibr.exr"
    rv3d = view().spaces.active.region_3d
    rv3d.view_perspective, rv3d.view_distance = "ORTHO", 6.0
    yield from drawn()
    yield from compare(told, sphere, "as baked")
    sphere.rsibr.follow_world = True
    turn_world()
    yield from compare(told, sphere, "world turned")
"""


def test_a_mirror_s_picture_is_cycles_s(told: Told) -> None:
    answer = told(MIRROR)
    assert len(answer) == 4
    for look, (median, most, mean) in answer.items():
        assert mean > 100.0, look  # Mesa encodes dark pixels badly: see in_window.like
        assert median <= 2.0, look
        # Mesa's 3, and 1 of interpolation between texels and of 8 bits
        assert most <= 5.0, look


DEPTHLESS = """
def scenario(told):
    bare(view())
    scene, space = bpy.context.scene, view().spaces.active
    scene.render.engine, scene.cycles.preview_samples = "CYCLES", 1
    scene.view_settings.view_transform = "Standard"
    cube = bpy.data.objects["Cube"]
    other = bpy.data.objects.new("Other", cube.data.copy())
    scene.collection.objects.link(other)
    other.location = space.region_3d.view_rotation @ Vector((1.0, 0.5, 3.0))
    cube.rsibr.map_set = "/job/mirror.rsibr.exr"
    yield from drawn()
    yield from drawn()

    def coverage():
        stage = session().previews._stage
        part = region(view())
        seen = np.array(stage.radiance.read()).reshape(*stage._size[::-1], 4)[: part.height, : part.width]
        return seen[..., 3] == 1.0

    whole, solid = coverage(), pixels()
    space.shading.type, space.overlay.show_overlays = "RENDERED", False
    yield from drawn_with_news()
    cut, shown = coverage(), pixels()
    told["whole"], told["cut"] = int(whole.sum()), int(cut.sum())
    told["same inside"] = float(np.abs(shown - solid)[cut].max())
    told["hidden"] = int((whole & ~cut).sum())
    other.hide_set(True)
    for _ in range(2):
        yield from drawn()
    told["free"] = int((coverage() != whole).sum())
"""


def test_without_blender_s_depths_surfaces_still_hide(told: Told) -> None:
    answer = told(DEPTHLESS)
    assert answer["hidden"] > 1000 < answer["cut"]
    assert answer["cut"] + answer["hidden"] == answer["whole"]
    # Over Blender's picture Mesa encodes, beneath overlays Blender does: Mesa's 3, see in_window.like, and 1
    assert answer["same inside"] <= 4.0
    assert answer["free"] == 0
