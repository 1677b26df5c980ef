"""A web page of objects in their own materials: what it draws is what viewports draw."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.look import PrincipledLook
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.device.context import ensure_context
from rsibr.rsibr_addon.device.drawing import Draw
from rsibr.rsibr_addon.device.own_materials import OwnMaterials
from rsibr.rsibr_addon.device.preview import PreviewRenderer
from rsibr.rsibr_addon.device.textured_mesh import GpuTexturedMesh
from rsibr.rsibr_addon.host.meshes import load_mesh
from rsibr.rsibr_addon.tasks.export.page.own_material import look_of, own_objects
from rsibr.rsibr_addon.tasks.export.page.own_objects import Ball, OwnObject
from rsibr.rsibr_addon.tasks.export.page.page import FILL, export_page
from rsibr.rsibr_addon.tasks.methods.kinds import open_map_set
from rsibr.tests.web.browser import driven
from rsibr.tests.web.test_page import SET_UP, SETTINGS, SIZE, VIEW, check_alike, light_file, radiance


def image(name: str, texels: np.ndarray, space: str, floats: bool = False) -> bpy.types.Image:
    made = bpy.data.images.new(name, texels.shape[1], texels.shape[0], alpha=True, float_buffer=floats)
    made.colorspace_settings.name = space
    made.pixels.foreach_set(texels.astype(np.float32).ravel())
    made.update()
    return made


def textured(name: str, **images: bpy.types.Image) -> bpy.types.Material:
    """A material whose inputs are images; Normal is a normal map."""
    material = bpy.data.materials.new(name)
    tree = material.node_tree
    shader = next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED")
    for socket, shown in images.items():
        node = tree.nodes.new("ShaderNodeTexImage")
        node.image = shown
        output = node.outputs["Alpha" if socket == "Alpha" else "Color"]
        if socket == "Alpha":
            node.extension = "CLIP"
        if socket == "Normal":
            mapped = tree.nodes.new("ShaderNodeNormalMap")
            tree.links.new(output, mapped.inputs["Color"])
            output = mapped.outputs["Normal"]
        tree.links.new(output, shader.inputs[socket])
    return material


def smooth(seed: int, low: float, high: float) -> np.ndarray:
    """Texels of 8 x 8 that repeat."""
    rng = np.random.default_rng(seed)
    texels = np.ones((8, 8, 4))
    texels[..., :3] = rng.uniform(low, high, (8, 8, 3))
    return texels


def objects() -> list[bpy.types.Object]:
    """A ball of two materials, one of images and one with holes, scaled unevenly; and a plain cube beside."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.mesh.primitive_cube_add(size=1.2, location=(2.0, 0.5, 0.0), rotation=(0.3, 0.2, 0.5))
    cube = bpy.context.object
    cube.data.materials.append(bpy.data.materials.new("plain"))
    cube.data.materials[0].node_tree.nodes["Principled BSDF"].inputs["Sheen Weight"].default_value = 0.25
    bpy.ops.mesh.primitive_uv_sphere_add(segments=24, ring_count=12)
    ball = bpy.context.object
    ball.scale, ball.rotation_euler = (1.0, 1.4, 0.8), (0.4, 0.1, 0.3)
    bpy.ops.object.shade_smooth()
    normals = smooth(3, 0.45, 0.55)
    normals[..., 2] = 1.0
    holes = smooth(4, 0.2, 0.9)
    holes[..., 3] = np.random.default_rng(5).choice([0.0, 0.5, 1.0], (8, 8))
    floats = image("floats", smooth(2, 0.2, 0.6), "Non-Color", floats=True)
    colours = {"Base Color": image("colours", smooth(1, 0.1, 0.9), "sRGB"), "Roughness": floats}
    ball.data.materials.append(textured("images", **colours, Normal=image("normals", normals, "Non-Color")))
    leaf = image("leaf", holes, "sRGB")
    ball.data.materials.append(textured("leaf", **{"Base Color": leaf, "Alpha": leaf}))
    for face in ball.data.polygons:
        face.material_index = int(face.center.z > 0.3)
    bpy.context.view_layer.update()
    return [cube, ball]


class Scene:
    """Objects in the light of a pyramid, drawn as viewports draw them."""

    def __init__(self, content: Any, shown: list[OwnObject]) -> None:
        self._content, self._shown = content, shown

    def draw(self, mesh: Any, placed: Draw, look: object) -> None:
        world = [each.mesh.positions @ each.matrix[:3, :3].T + each.matrix[:3, 3] for each in self._shown]
        ball = Ball.around(np.concatenate(world))
        ball = replace(ball, radius=ball.radius / FILL)
        placed = replace(
            placed,
            view=placed.view @ np.linalg.inv(ball.matrix),
            eye=np.append(ball.centre + ball.radius * placed.eye[:3], 1.0),
        )
        for each in self._shown:
            given = each.mesh
            parts = given.positions, given.normals, given.triangles, given.slots, given.uv, given.tangents
            uploaded = GpuTexturedMesh(*parts, given.uv_maps)
            self._content.draw(uploaded, replace(placed, model=each.matrix), OwnMaterials(each.slots))


@pytest.mark.slow
def test_a_page_of_own_materials_is_what_viewports_draw(tmp_path: Path) -> None:
    ensure_context()
    source, items = light_file(tmp_path, "kernel_pyramid"), objects()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    shown = own_objects(items, depsgraph)
    page = tmp_path / "page.html"
    drain(export_page(source, page, SETTINGS, shown))
    opened = open_map_set(source)
    renderer = PreviewRenderer(Scene(opened.drawable(), shown))
    sphere = load_mesh("sphere")
    surface = sphere.positions, sphere.normals, sphere.triangles
    wanted = renderer.draw(*surface, SETTINGS.camera(VIEW), SIZE, None)
    said = driven(page, SET_UP + "answer({pixels: encoded(first.pixels)});")
    check_alike(radiance(said["pixels"]), wanted)


def test_one_plain_material_keeps_its_sliders() -> None:
    ensure_context()
    items = objects()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    (cube,) = own_objects(items[:1], depsgraph)
    look = look_of(PrincipledLook(metallic=1.0, sheen_weight=1.0), [cube])
    assert (look.metallic, look.roughness, look.sheen_weight) == (0.0, 0.5, 0.25)
    assert look_of(PrincipledLook(), own_objects(items, depsgraph)) is None
