"""Normals of normal maps and bumps beside those of Cycles' nodes."""

from collections.abc import Callable

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.core.materials.normals import SurfacePoints, shading_normal
from rsibr.rsibr_addon.core.materials.principled import Bump, Input, Normal, NormalMap
from rsibr.rsibr_addon.host.principled import principled
from rsibr.tests.cycles.test_host_principled import SIZE, TEXELS, Nodes, baked, nodes

__all__ = ["nodes"]


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
    half = nodes.add("VectorMath", operation="MULTIPLY_ADD")
    for number in (1, 2):
        half.inputs[number].default_value = (0.5, 0.5, 0.5)
    nodes.link(node.outputs["Normal"], half.inputs[0])
    nodes.link(half.outputs[0], "Base Color")
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


def images_of(normal: Normal) -> list[Input]:
    if isinstance(normal, Bump):
        return [normal.height, *images_of(normal.normal)]
    return [normal.color] if isinstance(normal, NormalMap) else []
