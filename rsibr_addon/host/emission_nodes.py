"""A material's inputs as the light that it gives off, so that Cycles bakes them."""

from collections.abc import Mapping, Sequence

import bpy
import numpy as np

from ..core.materials.packing import Picture
from .materials import surface_output
from .surfaces import NORMAL_INPUTS, Leaf, MixedValue, Origin, Surface, Value, leaves, origins, surface_of


def emitting(material: bpy.types.Material, picture: Picture, uv_map: str) -> bpy.types.Material:
    """A copy of a material that gives off what a picture holds.

    Parameters
    ----------
    material : bpy.types.Material
        As `principled` describes it; it stays as it is.
    picture : Picture
    uv_map : str
        UV map of the tangents in which normals are expressed.

    Notes
    -----
    Emissions stand where the shaders stood, also within groups, so all that feeds the ones feeds the others,
    and mixes of shaders mix their inputs.
    """
    copy = material.copy()
    _own_groups(copy.node_tree)
    output = surface_output(copy)
    assert output is not None
    for name in ("Displacement", "Volume"):
        for link in list(output.inputs[name].links):
            copy.node_tree.links.remove(link)
    surface = surface_of(copy)
    found = origins(surface)
    _emit(surface, {name: found[name] for name in picture}, uv_map)
    return copy


def _emit(surface: Surface, values: Mapping[str, Origin], uv_map: str) -> None:
    """Put emissions in the place of shaders. Of a mixture there is one value."""
    if isinstance(surface, Leaf):
        _emit_leaf(surface, values, uv_map)
        return
    ((name, origin),) = values.items()
    if isinstance(origin, MixedValue) and origin.mixture == surface:
        _emit(surface.first, {name: origin.first}, uv_map)
        _emit(surface.second, {name: origin.second}, uv_map)
        return
    # One of both decides alone
    number = 0 if _first_leaf(origin) in leaves(surface.first) else 1
    shader = [each for each in surface.node.inputs if each.type == "SHADER"][number].links[0].from_socket
    for link in list(surface.node.outputs[0].links):
        surface.node.id_data.links.new(shader, link.to_socket)
    _emit((surface.first, surface.second)[number], values, uv_map)


def _first_leaf(origin: Origin) -> Leaf:
    return origin.leaf if isinstance(origin, Value) else _first_leaf(origin.first)


def _emit_leaf(leaf: Leaf, values: Mapping[str, Origin], uv_map: str) -> None:
    tree = leaf.node.id_data
    emission = tree.nodes.new("ShaderNodeEmission")
    ends = [emission.inputs["Color"]]
    if len(values) > 1:
        joined = tree.nodes.new("ShaderNodeCombineColor")
        tree.links.new(joined.outputs[0], ends[0])
        ends = list(joined.inputs)
    for (name, value), end in zip(values.items(), ends, strict=False):
        assert isinstance(value, Value)
        if not value.name:
            _set(end, value.numbers)
        elif name in NORMAL_INPUTS:
            _feed_normal(value.socket, end, uv_map)
        else:
            _feed(value.socket, end)
    for link in list(leaf.node.outputs[0].links):
        tree.links.new(emission.outputs[0], link.to_socket)


def _own_groups(tree: bpy.types.NodeTree) -> None:
    """Have a tree use copies of its groups, so that it may change them."""
    for node in tree.nodes:
        if node.bl_idname == "ShaderNodeGroup" and node.node_tree:
            node.node_tree = node.node_tree.copy()
            _own_groups(node.node_tree)


def _feed(socket: bpy.types.NodeSocket, end: bpy.types.NodeSocket) -> None:
    """Link what an input is linked from to another input, or give it the same value."""
    link = next((link for link in socket.links if link.is_valid and not link.is_muted), None)
    if link:
        socket.id_data.links.new(link.from_socket, end)
    else:
        value = socket.default_value
        _set(end, (value,) if isinstance(value, float) else value[:3])


def _set(end: bpy.types.NodeSocket, numbers: Sequence[float]) -> None:
    """Give an input numbers; a value stands for all three of a colour."""
    if isinstance(end.default_value, float):
        end.default_value = numbers[0]
    else:
        end.default_value = (*np.broadcast_to(numbers, 3).tolist(), 1.0)


def _feed_normal(socket: bpy.types.NodeSocket, end: bpy.types.NodeSocket, uv_map: str) -> None:
    """Feed 0.5 + 0.5 n, n being a normal in tangent space.

    The axes are what Cycles' node makes of their colours, so its inverse is exact. They need not be at right
    angles: n's numbers are those of the dual axes.
    """
    tree = socket.id_data
    if not socket.is_linked:
        _set(end, (0.5, 0.5, 1.0))
        return
    axes = [_axis(tree, color, uv_map) for color in ((1.0, 0.5, 0.5), (0.5, 1.0, 0.5), (0.5, 0.5, 1.0))]
    normal = socket.links[0].from_socket
    joined = tree.nodes.new("ShaderNodeCombineXYZ")
    for number in range(3):
        first, second = axes[(number + 1) % 3], axes[(number + 2) % 3]
        dual = _vector_math(tree, "CROSS_PRODUCT", first, second)
        along = _vector_math(tree, "DOT_PRODUCT", dual, normal)
        # Divided by the axes' volume, whose sign a mirrored unwrapping turns
        volume = _vector_math(tree, "DOT_PRODUCT", dual, axes[number])
        share = tree.nodes.new("ShaderNodeMath")
        share.operation = "DIVIDE"
        tree.links.new(along, share.inputs[0])
        tree.links.new(volume, share.inputs[1])
        tree.links.new(share.outputs[0], joined.inputs[number])
    unit = _vector_math(tree, "NORMALIZE", joined.outputs[0])
    encoded = tree.nodes.new("ShaderNodeVectorMath")
    encoded.operation = "MULTIPLY_ADD"
    encoded.inputs[1].default_value = encoded.inputs[2].default_value = (0.5, 0.5, 0.5)
    tree.links.new(unit, encoded.inputs[0])
    tree.links.new(encoded.outputs[0], end)


def _axis(tree: bpy.types.NodeTree, color: tuple[float, float, float], uv_map: str) -> bpy.types.NodeSocket:
    node = tree.nodes.new("ShaderNodeNormalMap")
    node.uv_map = uv_map
    node.inputs["Color"].default_value = (*color, 1.0)
    axis: bpy.types.NodeSocket = node.outputs[0]
    return axis


def _vector_math(
    tree: bpy.types.NodeTree, operation: str, *vectors: bpy.types.NodeSocket
) -> bpy.types.NodeSocket:
    node = tree.nodes.new("ShaderNodeVectorMath")
    node.operation = operation
    for vector, socket in zip(vectors, node.inputs, strict=False):
        tree.links.new(vector, socket)
    result: bpy.types.NodeSocket = node.outputs["Value" if operation == "DOT_PRODUCT" else "Vector"]
    return result
