"""Normals of normal maps and bumps beside those of Cycles' nodes."""

from collections.abc import Callable

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.core.materials.normals import SurfacePoints, shading_normal
from rsibr.rsibr_addon.core.materials.principled import Bump, Input, Normal, NormalMap
from rsibr.rsibr_addon.host.principled import principled
from rsibr.rsibr_addon.host.rendering import configure_cycles, render_passes
from rsibr.tests.cycles.test_host_principled import SIZE, TEXELS, Nodes, baked, nodes

__all__ = ["nodes"]

SLOPE = np.array([[[0.2] * 4, [0.8] * 4]], np.float32)


def mapped(nodes: Nodes) -> bpy.types.Node:
    node = nodes.add("NormalMap")
    node.inputs["Strength"].default_value = 0.7
    nodes.link(nodes.image().outputs["Color"], node.inputs["Color"])
    return node


def strongly_mapped(nodes: Nodes) -> bpy.types.Node:
    node = mapped(nodes)
    node.inputs["Strength"].default_value = 2.5
    return node


def bumped(nodes: Nodes) -> bpy.types.Node:
    node = nodes.add("Bump")
    node.inputs["Strength"].default_value, node.inputs["Distance"].default_value = 0.6, 0.3
    nodes.link(nodes.image().outputs["Color"], node.inputs["Height"])
    return node


def inverted(nodes: Nodes) -> bpy.types.Node:
    node = bumped(nodes)
    node.invert = True
    return node


def bumped_and_mapped(nodes: Nodes) -> bpy.types.Node:
    node = bumped(nodes)
    nodes.link(mapped(nodes).outputs["Normal"], node.inputs["Normal"])
    return node


@pytest.mark.parametrize("make", [mapped, strongly_mapped, bumped, inverted, bumped_and_mapped])
def test_normals_are_those_of_cycles(nodes: Nodes, make: Callable[[Nodes], bpy.types.Node]) -> None:
    node = make(nodes)
    nodes.link(node.outputs["Normal"], "Normal")
    inputs = principled(nodes.material)
    nodes.link(encoded(nodes, node), "Base Color")
    shown = 2.0 * baked(nodes, "Base Color").reshape(-1, 3) - 1.0
    centre = (np.arange(SIZE) + 0.5) / SIZE
    uv = np.stack(np.meshgrid(centre, centre), axis=-1).reshape(-1, 2)
    steps = np.eye(2)[:, None] / SIZE * np.ones((len(uv), 1))
    points = SurfacePoints(
        np.broadcast_to([0.0, 0.0, 1.0], (len(uv), 3)),
        np.broadcast_to([1.0, 0.0, 0.0, 1.0], (len(uv), 4)),
        {"": uv},
        np.concatenate([steps, np.zeros((2, len(uv), 1))], axis=-1),
        {"": steps},
    )
    textures = {each.texture for each in images_of(inputs.normal) if each.texture}
    ours = shading_normal(inputs.normal, dict.fromkeys(textures, TEXELS), points)
    apart = np.linalg.norm(ours - shown, axis=-1)
    # Cycles' images are half floats, with bilinear weights of 8 bits. A bump's differences over a tenth of a
    # pixel have ten times that error, and theirs is another slope where the tenth crosses a line of texels.
    assert np.quantile(apart, 0.9) < (2.5e-2 if isinstance(inputs.normal, Bump) else 5e-3)
    assert apart.mean() < (1e-2 if isinstance(inputs.normal, Bump) else 2e-3)
    assert np.linalg.norm(ours - [0.0, 0.0, 1.0], axis=-1).mean() > 0.1


def leaning(nodes: Nodes) -> bpy.types.Node:
    node = nodes.add("NormalMap")
    node.inputs["Color"].default_value = (0.3, 0.6, 0.9, 1.0)
    return node


def sloping(nodes: Nodes) -> bpy.types.Node:
    """A bump that rises evenly between the middles of both halves."""
    image = bpy.data.images.new("slope", 2, 1, float_buffer=True)
    image.pixels.foreach_set(SLOPE.ravel())
    image.update()
    image.pack()
    node = nodes.add("Bump")
    node.inputs["Strength"].default_value, node.inputs["Distance"].default_value = 0.6, 0.3
    nodes.link(nodes.add("TexImage", image=image).outputs["Color"], node.inputs["Height"])
    return node


def sloping_inwards(nodes: Nodes) -> bpy.types.Node:
    node = sloping(nodes)
    node.invert = True
    return node


def sloping_and_leaning(nodes: Nodes) -> bpy.types.Node:
    node = sloping(nodes)
    nodes.link(leaning(nodes).outputs["Normal"], node.inputs["Normal"])
    return node


@pytest.mark.parametrize("outside", [True, False])
@pytest.mark.parametrize("make", [leaning, sloping, sloping_inwards, sloping_and_leaning])
def test_normals_of_either_side_are_those_of_cycles(
    nodes: Nodes, make: Callable[[Nodes], bpy.types.Node], outside: bool
) -> None:
    node = make(nodes)
    nodes.link(node.outputs["Normal"], "Normal")
    inputs = principled(nodes.material)
    shown = 2.0 * seen_in_the_middle(nodes, encoded(nodes, node), outside) - 1.0
    step = np.eye(2)[:, None] * 0.01
    points = SurfacePoints(
        np.array([[0.0, 0.0, 1.0]]),
        np.array([[1.0, 0.0, 0.0, 1.0]]),
        {"": np.array([[0.5, 0.5]])},
        np.concatenate([step, np.zeros((2, 1, 1))], axis=-1),
        {"": step},
    )
    textures = {each.texture for each in images_of(inputs.normal) if each.texture}
    (ours,) = shading_normal(inputs.normal, dict.fromkeys(textures, SLOPE), points)
    # A slope errs as half floats do, by 2^-11, over the rise of .6
    np.testing.assert_allclose(ours if outside else -ours, shown, atol=1e-3)


def encoded(nodes: Nodes, node: bpy.types.Node) -> bpy.types.NodeSocket:
    """A node's normal as a colour, 0.5 + 0.5 n."""
    half = nodes.add("VectorMath", operation="MULTIPLY_ADD")
    for number in (1, 2):
        half.inputs[number].default_value = (0.5, 0.5, 0.5)
    nodes.link(node.outputs["Normal"], half.inputs[0])
    return half.outputs[0]


def seen_in_the_middle(nodes: Nodes, color: bpy.types.NodeSocket, outside: bool) -> np.ndarray:
    """A colour as Cycles shows it around the middle of the unit square, from above or below, shape (3,)."""
    emission = nodes.add("Emission")
    nodes.link(color, emission.inputs["Color"])
    nodes.link(emission.outputs[0], nodes.tree.get_output_node("CYCLES").inputs["Surface"])
    scene = bpy.data.scenes.new("side")
    configure_cycles(scene, 8, 8, 16)
    mesh = bpy.data.meshes.new("square")
    mesh.from_pydata([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [], [(0, 1, 2, 3)])
    mesh.uv_layers.new(name="UVMap").data.foreach_set("uv", [0, 0, 1, 0, 1, 1, 0, 1])
    mesh.materials.append(nodes.material)
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.type, camera.data.ortho_scale = "ORTHO", 0.2
    camera.location = (0.5, 0.5, 1.0 if outside else -1.0)
    camera.rotation_euler.x = 0.0 if outside else np.pi
    for each in (bpy.data.objects.new("square", mesh), camera):
        scene.collection.objects.link(each)
    scene.camera = camera
    return render_passes(scene)["Combined"][..., :3].mean(axis=(0, 1))


def images_of(normal: Normal) -> list[Input]:
    if isinstance(normal, Bump):
        return [normal.height, *images_of(normal.normal)]
    return [normal.color] if isinstance(normal, NormalMap) else []
