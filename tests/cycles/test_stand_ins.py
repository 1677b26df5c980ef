"""What is shown where there is no material, surface or image, beside Cycles in even light of 1."""

from collections.abc import Callable

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.core.materials.principled import PrincipledInputs, constant
from rsibr.rsibr_addon.core.materials.stand_ins import BLACK, UNASSIGNED, without_image
from rsibr.rsibr_addon.host.principled import principled
from rsibr.rsibr_addon.host.rendering import configure_cycles, render_passes
from rsibr.rsibr_addon.host.scenes import temporary_scene


def nothing(_: bpy.types.Material) -> None:
    return None


def without_surface(material: bpy.types.Material) -> bpy.types.Material:
    material.node_tree.links.clear()
    return material


def without_output(material: bpy.types.Material) -> bpy.types.Material:
    material.node_tree.nodes.clear()
    return material


@pytest.mark.parametrize(
    ("change", "inputs"), [(nothing, UNASSIGNED), (without_surface, BLACK), (without_output, BLACK)]
)
def test_what_is_not_there_looks_as_in_cycles(
    change: Callable[[bpy.types.Material], bpy.types.Material | None], inputs: PrincipledInputs
) -> None:
    with temporary_scene() as scene:
        seen = seen_of(scene, change(bpy.data.materials.new("material")))
    # Without a boundary all that is reflected is diffuse: the base colour. 4096 samples are within 1/64
    assert inputs.specular_level == constant((0.0,))
    np.testing.assert_allclose(seen, inputs.base_color.constant, atol=0.05)


def test_an_image_that_is_not_there_looks_as_in_cycles() -> None:
    with temporary_scene() as scene:
        material = bpy.data.materials.new("material")
        image = bpy.data.images.new("lost", 4, 4)
        image.source, image.filepath = "FILE", "//lost.png"
        tree = material.node_tree
        node, bsdf = tree.nodes.new("ShaderNodeTexImage"), tree.nodes["Principled BSDF"]
        node.image = image
        bsdf.inputs["Specular IOR Level"].default_value = 0.0
        tree.links.new(node.outputs["Color"], bsdf.inputs["Base Color"])
        expected = without_image(principled(material).base_color)
        np.testing.assert_allclose(seen_of(scene, material), expected.constant, atol=0.05)


def seen_of(scene: bpy.types.Scene, material: bpy.types.Material | None) -> np.ndarray:
    """What Cycles shows of a square of a material, shape (3,)."""
    configure_cycles(scene, 4, 4, 256)
    scene.world = bpy.data.worlds.new("even")
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    mesh = bpy.data.meshes.new("square")
    mesh.from_pydata([(-3, -3, 0), (3, -3, 0), (3, 3, 0), (-3, 3, 0)], [], [(0, 1, 2, 3)])
    mesh.materials.append(material)
    scene.collection.objects.link(bpy.data.objects.new("square", mesh))
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.type, camera.data.ortho_scale, camera.location.z = "ORTHO", 2.0, 5.0
    scene.collection.objects.link(camera)
    scene.camera = camera
    return render_passes(scene)["Combined"][..., :3].mean(axis=(0, 1))
