"""A material's inputs as the light that it gives off, so that Cycles bakes them."""

import bpy

from ..core.materials.packing import COLORS, NORMALS, Picture
from .input_nodes import source
from .materials import surface_output
from .principled import INPUTS, NORMAL_INPUTS


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
    The emission stands where the Principled BSDF stood, also within a group, so all that feeds the one feeds
    the other.
    """
    copy = material.copy()
    _own_groups(copy.node_tree)
    output = surface_output(copy)
    assert output is not None
    for name in ("Displacement", "Volume"):
        for link in list(output.inputs[name].links):
            copy.node_tree.links.remove(link)
    end, _ = source(output.inputs["Surface"], ())
    tree = end.node.id_data
    emission = tree.nodes.new("ShaderNodeEmission")
    if picture[0] in NORMALS:
        _feed_normal(end.node.inputs[NORMAL_INPUTS[picture[0]]], emission.inputs["Color"], uv_map)
    elif picture[0] in COLORS:
        _feed(end.node.inputs[INPUTS[picture[0]]], emission.inputs["Color"])
    else:
        joined = tree.nodes.new("ShaderNodeCombineColor")
        for name, channel in zip(picture, joined.inputs, strict=False):
            _feed(end.node.inputs[INPUTS[name]], channel)
        tree.links.new(joined.outputs[0], emission.inputs["Color"])
    for link in list(end.links):
        tree.links.new(emission.outputs[0], link.to_socket)
    return copy


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
        end.default_value = socket.default_value


def _feed_normal(socket: bpy.types.NodeSocket, end: bpy.types.NodeSocket, uv_map: str) -> None:
    """Feed 0.5 + 0.5 n, n being a normal in tangent space.

    The axes are what Cycles' node makes of their colours, so its inverse is exact. They need not be at right
    angles: n's numbers are those of the dual axes.
    """
    tree = socket.id_data
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
