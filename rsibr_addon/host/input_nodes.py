"""The nodes behind an input, followed as far as they are affine in the texels of one image."""

from collections.abc import Callable, Sequence
from typing import Any

import bpy
import numpy as np
from mathutils import Euler, Matrix

from ..core.materials.principled import Affine, Input, Row, Texture, constant

Groups = tuple[bpy.types.Node, ...]
"""The group nodes that a node lies in, the outermost first."""

LUMINANCE = (0.2126, 0.7152, 0.0722)
"""Rec. 709's, by which Cycles makes a value of a colour, in a file that works in Rec. 709."""

ROUNDING = 1e-4
"""Weights of channels sum up to 1 but for so much, as LUMINANCE is rounded."""

Read = Callable[[bpy.types.NodeSocket, Groups], Input]
"""`Reading.of`."""

NO_IMAGE = (1.0, 0.0, 1.0)
"""What Cycles shows for an image that is not there."""


class NotFollowedError(Exception):
    """What feeds an input is neither constant nor affine in one image."""

    def __init__(self, reason: str) -> None:
        super().__init__(reason)
        self.reason = reason


def source(socket: bpy.types.NodeSocket, groups: Groups) -> tuple[bpy.types.NodeSocket, Groups]:
    """Where an input's value comes from, through reroutes, groups and muted nodes.

    Parameters
    ----------
    socket : bpy.types.NodeSocket
        An input.
    groups : Groups
        What its node lies in.

    Returns
    -------
    socket : bpy.types.NodeSocket
        The output of a node that computes it; or an input that is not linked.
    groups : Groups
        What that socket's node lies in.

    Raises
    ------
    NotFollowedError
        A group has no tree or no output.
    """
    while (found := step(socket, groups)) is not None:
        socket, groups = found
    return socket, groups


def step(socket: bpy.types.NodeSocket, groups: Groups) -> tuple[bpy.types.NodeSocket, Groups] | None:
    """The socket that this one's value is passed on from; None where `source` ends."""
    node = socket.node
    if not socket.is_output:
        # Asked for its links, Blender looks through those of the whole tree
        links = socket.links if socket.is_linked else ()
        link = next((link for link in links if link.is_valid and not link.is_muted), None)
        return (link.from_socket, groups) if link else None
    if node.mute:
        passed = next((link for link in node.internal_links if link.to_socket == socket), None)
        return (passed.from_socket, groups) if passed else None
    if node.bl_idname == "NodeReroute":
        return node.inputs[0], groups
    if node.bl_idname == "NodeGroupInput" and groups:
        return _same(groups[-1].inputs, socket), groups[:-1]
    if node.bl_idname == "ShaderNodeGroup":
        nodes = node.node_tree.nodes if node.node_tree else ()
        ends = (each for each in nodes if each.bl_idname == "NodeGroupOutput" and each.is_active_output)
        end = next(ends, None)
        if end is None:
            raise NotFollowedError("a group without an output")
        return _same(end.inputs, socket), (*groups, node)
    return None


class Reading:
    """Reads inputs of a material that stays as it is meanwhile.

    Each output of a node is read once, however many inputs it feeds: else every node that uses an input twice
    would double the work for all before it.
    """

    def __init__(self) -> None:
        self._outputs: dict[tuple[bpy.types.NodeSocket, Groups], Input] = {}

    def of(self, socket: bpy.types.NodeSocket, groups: Groups) -> Input:
        """What an input, or an output, is.

        Raises
        ------
        NotFollowedError
        """
        found = step(socket, groups)
        if found is not None:
            before, groups = found
            return _converted(self.of(before, groups), before.type, socket.type)
        if not socket.is_output:
            return _default(socket)
        node = socket.node
        if node.mute:
            return constant((0.0,) * (1 if socket.type == "VALUE" else 3))
        if node.bl_idname not in NODES:
            raise NotFollowedError(node.bl_label)
        if (socket, groups) not in self._outputs:
            self._outputs[socket, groups] = NODES[node.bl_idname](socket, groups, self.of)
        return self._outputs[socket, groups]


def _same(sockets: Any, socket: bpy.types.NodeSocket) -> bpy.types.NodeSocket:
    same: bpy.types.NodeSocket = next(each for each in sockets if each.identifier == socket.identifier)
    return same


def _default(socket: bpy.types.NodeSocket) -> Input:
    if not hasattr(socket, "default_value"):
        raise NotFollowedError("a shader that is not linked")
    value = socket.default_value
    return constant((value,) if isinstance(value, int | float) else tuple(value)[:3])


def _converted(value: Input, before: str, after: str) -> Input:
    """Cycles' implicit conversion between types of sockets."""
    if after == "VALUE" and len(value.rows) == 3:
        weights = LUMINANCE if before == "RGBA" else (1 / 3, 1 / 3, 1 / 3)
        return Input((_sum(value.rows, weights),), value.texture)
    if after in ("RGBA", "VECTOR") and len(value.rows) == 1:
        return Input(value.rows * 3, value.texture)
    return value


def _sum(rows: Sequence[Row], weights: Sequence[float]) -> Row:
    a, b, c, d, e = (
        sum(weight * number for weight, number in zip(weights, column, strict=True))
        for column in zip(*rows, strict=True)
    )
    return a, b, c, d, e


def _combined(first: Input, second: Input, of_first: Sequence[float], of_second: Sequence[float]) -> Input:
    """A weighted sum of two inputs, a weight for each number."""
    if first.texture and second.texture and first.texture != second.texture:
        raise NotFollowedError("several images in one input")
    weights = zip(of_first, of_second, strict=True)
    pairs = zip(first.rows, second.rows, strict=True)
    rows = tuple(_sum(pair, weight) for pair, weight in zip(pairs, weights, strict=True))
    return Input(rows, first.texture or second.texture)


def _product(first: Input, second: Input) -> Input:
    if first.texture and second.texture:
        raise NotFollowedError("a product of images")
    scaled, factors = (second, first) if second.texture else (first, second)
    return _combined(scaled, constant([0.0] * len(scaled.rows)), factors.constant, factors.constant)


def mixed(first: Input, second: Input, factor: Input) -> Input:
    """Two inputs, mixed as shaders are.

    Raises
    ------
    NotFollowedError
        That is affine in no image, or the factor has to be kept within 0 and 1.
    """
    if not factor.texture:
        return _mixed(first, second, factor.constant[0])
    (*of_texel, added) = factor.rows[0]
    low, high = (added + sum(end(each, 0.0) for each in of_texel) for end in (min, max))
    if low < -ROUNDING or high > 1.0 + ROUNDING:
        raise NotFollowedError("a mix beyond its ends")
    count = len(first.rows)
    difference = _combined(second, first, [1.0] * count, [-1.0] * count)
    share = _product(difference, Input(factor.rows * count, factor.texture))
    return _combined(first, share, [1.0] * count, [1.0] * count)


def _mixed(first: Input, second: Input, factor: float) -> Input:
    count = len(first.rows)
    return _combined(first, second, [1.0 - factor] * count, [factor] * count)


def _factor(socket: bpy.types.NodeSocket, groups: Groups, read: Read) -> float:
    factor = read(socket, groups)
    if factor.texture:
        raise NotFollowedError("a mix by an image")
    return factor.constant[0]


def _image(socket: bpy.types.NodeSocket, groups: Groups, read: Read) -> Input:
    node, image = socket.node, socket.node.image
    is_alpha = socket.identifier == "Alpha"
    if image is None:
        return constant((1.0,) if is_alpha else NO_IMAGE)
    if node.projection != "FLAT":
        raise NotFollowedError("an image that is not projected flat")
    if image.source in ("TILED", "MOVIE", "SEQUENCE", "VIEWER"):
        raise NotFollowedError(
            {"TILED": "UDIM tiles", "VIEWER": "a render's result"}.get(image.source, "a movie")
        )
    own = node.texture_mapping
    if own.scale[:] != (1.0, 1.0, 1.0) or any(own.translation) or any(own.rotation):
        raise NotFollowedError("an image node's own mapping")
    uv_map, matrix = _coordinates(node.inputs["Vector"], groups, read)
    mapping: Affine = (*matrix[0].xy, matrix[0].w, *matrix[1].xy, matrix[1].w)
    library = image.library.filepath if image.library else ""
    closest = node.interpolation == "Closest"
    covered = _is_covered(image) and not node.outputs["Alpha"].is_linked
    texture = Texture(image.name, library, uv_map, mapping, node.extension, closest, covered=covered)
    rows = ALPHA if is_alpha else RGB
    return Input(rows, texture)


def _is_covered(image: bpy.types.Image) -> bool:
    """Whether Cycles multiplies an image's colours by alpha, where the node's alpha is not linked."""
    has_alpha = image.depth in (32, 64, 128)
    return has_alpha and image.alpha_mode == "STRAIGHT" and not image.colorspace_settings.is_data


RGB: tuple[Row, ...] = ((1.0, 0.0, 0.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 1.0, 0.0, 0.0))
ALPHA: tuple[Row, ...] = ((0.0, 0.0, 0.0, 1.0, 0.0),)


def _coordinates(socket: bpy.types.NodeSocket, groups: Groups, read: Read) -> tuple[str, Matrix]:
    """The UV map that feeds an input, and a matrix from it."""
    end, groups = source(socket, groups)
    node = end.node
    if not end.is_output:
        if node.bl_idname != "ShaderNodeTexImage":
            raise NotFollowedError("an image at one point")
        return "", Matrix()
    if node.bl_idname == "ShaderNodeUVMap" and not node.from_instancer:
        return node.uv_map, Matrix()
    if node.bl_idname == "ShaderNodeTexCoord" and end.identifier == "UV" and not node.from_instancer:
        return "", Matrix()
    if node.bl_idname == "ShaderNodeMapping" and node.vector_type != "NORMAL":
        uv_map, before = _coordinates(node.inputs["Vector"], groups, read)
        return uv_map, _mapping(node, groups, read) @ before
    raise NotFollowedError(f"{node.bl_label} as coordinates")


def _mapping(node: bpy.types.Node, groups: Groups, read: Read) -> Matrix:
    rotation, scale = (_fixed(node.inputs[name], groups, read) for name in ("Rotation", "Scale"))
    # Blender takes the input of a node that maps vectors away
    location = (
        (0.0, 0.0, 0.0) if node.vector_type == "VECTOR" else _fixed(node.inputs["Location"], groups, read)
    )
    matrix = Matrix.LocRotScale(location, Euler(rotation), scale)
    if node.vector_type == "TEXTURE":
        if not np.all(scale):
            raise NotFollowedError("a mapping to one point")
        return matrix.inverted()
    return matrix


def _fixed(socket: bpy.types.NodeSocket, groups: Groups, read: Read) -> tuple[float, ...]:
    value = read(socket, groups)
    if value.texture:
        raise NotFollowedError("a mapping by an image")
    return value.constant


def _own_value(socket: bpy.types.NodeSocket, groups: Groups, read: Read) -> Input:
    return _default(socket)


def _math(socket: bpy.types.NodeSocket, groups: Groups, read: Read) -> Input:
    node = socket.node
    if node.use_clamp or node.operation not in ("ADD", "SUBTRACT", "MULTIPLY"):
        raise NotFollowedError(f"Math of the operation {node.operation.lower()}")
    first, second = (read(node.inputs[number], groups) for number in (0, 1))
    if node.operation == "MULTIPLY":
        return _product(first, second)
    return _combined(first, second, [1.0], [1.0 if node.operation == "ADD" else -1.0])


def _mix(socket: bpy.types.NodeSocket, groups: Groups, read: Read) -> Input:
    node = socket.node
    if node.data_type not in ("RGBA", "FLOAT") or node.clamp_result:
        raise NotFollowedError("a mix that clamps, or is of vectors")
    inputs = [each for each in node.inputs if each.enabled]
    factor = _factor(inputs[0], groups, read)
    if node.clamp_factor:
        factor = min(max(factor, 0.0), 1.0)
    first, second = (read(each, groups) for each in inputs[1:])
    blend = node.blend_type if node.data_type == "RGBA" else "MIX"
    if blend == "MIX":
        return _mixed(first, second, factor)
    if blend == "MULTIPLY":
        return _mixed(first, _product(first, second), factor)
    if blend in ("ADD", "SUBTRACT"):
        return _combined(first, second, [1.0] * 3, [factor if blend == "ADD" else -factor] * 3)
    raise NotFollowedError(f"a mix of the kind {blend.lower()}")


def _inverted(socket: bpy.types.NodeSocket, groups: Groups, read: Read) -> Input:
    factor = _factor(socket.node.inputs["Factor"], groups, read)
    color = read(socket.node.inputs["Color"], groups)
    return _combined(color, constant((1.0,) * 3), [1.0 - 2.0 * factor] * 3, [factor] * 3)


def _separated(socket: bpy.types.NodeSocket, groups: Groups, read: Read) -> Input:
    if socket.node.mode != "RGB":
        raise NotFollowedError("Separate Color of other than RGB")
    color = read(socket.node.inputs["Color"], groups)
    number = ("Red", "Green", "Blue").index(socket.identifier)
    return Input((color.rows[number],), color.texture if any(color.rows[number][:4]) else None)


def _gray(socket: bpy.types.NodeSocket, groups: Groups, read: Read) -> Input:
    return _converted(read(socket.node.inputs["Color"], groups), "RGBA", "VALUE")


NODES: dict[str, Callable[[bpy.types.NodeSocket, Groups, Read], Input]] = {
    "ShaderNodeTexImage": _image,
    "ShaderNodeRGB": _own_value,
    "ShaderNodeValue": _own_value,
    "ShaderNodeMath": _math,
    "ShaderNodeMix": _mix,
    "ShaderNodeInvert": _inverted,
    "ShaderNodeSeparateColor": _separated,
    "ShaderNodeRGBToBW": _gray,
}
"""Type of node -> how its output is read."""
