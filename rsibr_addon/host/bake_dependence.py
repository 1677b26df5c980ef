"""What a bake of a material's inputs depends on beside the material."""

import hashlib
import json
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import bpy
import numpy as np

from ..core.conventions import Array
from ..core.materials.packing import Picture
from .materials import MATRIX_DIGITS, fingerprint, node_fingerprint, surface_output
from .mesh_arrays import read_property
from .meshes import content_of, evaluated_mesh
from .shape_dependence import outputs_behind
from .surfaces import MixedValue, Origin, is_in_group, origins, surface_of

VIEW_NODES = ("ShaderNodeCameraData", "ShaderNodeFresnel", "ShaderNodeLayerWeight", "ShaderNodeLightPath")
VIEW_OUTPUTS = {
    "ShaderNodeNewGeometry": ("Backfacing", "Incoming"),
    "ShaderNodeTexCoord": ("Camera", "Reflection", "Window"),
}
"""Nodes, and outputs of others, that differ between views."""

OBJECT_NODES = ("ShaderNodeAttribute", "ShaderNodeObjectInfo")
"""Nodes that read what an object is: its name, by random numbers, its color, its properties."""

PLACE_NODES = ("ShaderNodeObjectInfo", "ShaderNodeVectTransform")
PLACE_OUTPUTS = {
    "ShaderNodeNewGeometry": ("Normal", "Position", "Tangent", "True Normal"),
    "ShaderNodeTexCoord": ("Camera", "Object", "Reflection", "Window"),
}
"""Nodes, and outputs of others, that differ between places of an object."""

FIELDS: dict[str, tuple[str, Any, int]] = {
    "BOOLEAN": ("value", np.bool_, 1),
    "BYTE_COLOR": ("color", np.float32, 4),
    "FLOAT": ("value", np.float32, 1),
    "FLOAT2": ("vector", np.float32, 2),
    "FLOAT_COLOR": ("color", np.float32, 4),
    "FLOAT_VECTOR": ("vector", np.float32, 3),
    "INT": ("value", np.int32, 1),
}
"""Type of attribute -> how it is read."""

PAIRS = "FLOAT2"
"""Type of attributes such as UV maps. Bevel adds them up in the order of addresses in memory, so their last
bits differ each time that Blender evaluates a mesh."""

PAIRS_OF_MEAN, STEPS = 4096, 9973.0
"""Pairs of an evaluated mesh count by weighted means of so many, in steps of 1 / `STEPS`: means have hardly
any of that noise. Each pair has another weight, so that what is turned about its middle is another."""


def view_dependence(material: bpy.types.Material) -> str:
    """Names of nodes by which a material differs between views, joined; empty for none."""
    nodes = _nodes(material, VIEW_NODES, VIEW_OUTPUTS)
    return " and ".join(dict.fromkeys(node.bl_label for node in nodes))


def content_for_bakes(
    item: bpy.types.Object, wanted: Mapping[int, Sequence[Picture]], depsgraph: bpy.types.Depsgraph
) -> dict[str, Any]:
    """All of an object that a bake of its materials' inputs depends on, to be hashed.

    Parameters
    ----------
    item : bpy.types.Object
    wanted : mapping of int to sequence of Picture
        Slot -> what is baked of its material.
    depsgraph : bpy.types.Depsgraph
        Evaluated, and holding `item`.

    Returns
    -------
    dict
        JSON values. An object's name and place are among them if its materials read them, so that copies of
        others share their bake.
    """
    materials = {slot: item.material_slots[slot].material for slot in wanted}
    reads_object = any(_nodes(material, OBJECT_NODES, {}) for material in materials.values())
    reads_place = any(_nodes(material, PLACE_NODES, PLACE_OUTPUTS) for material in materials.values())
    return {
        "materials": {
            slot: _inputs_content(material, [field for picture in wanted[slot] for field in picture])
            for slot, material in materials.items()
        },
        "mesh": _mesh_content(item, depsgraph),
        "object": _object_content(item) if reads_object else None,
        "place": np.round(np.array(item.matrix_world), MATRIX_DIGITS).tolist() if reads_place else None,
        "working_space": bpy.data.colorspace.working_space,
    }


def _inputs_content(material: bpy.types.Material, fields: Sequence[str]) -> Any:
    """All nodes that feed what is baked, and how: an edit of anything else needs no other bake.

    Where a shader or a mix of some is in a group, that is the whole material.
    """
    surface = surface_of(material)
    if is_in_group(surface):
        return fingerprint(material)
    found = origins(surface)
    nodes: dict[str, Any] = {}
    return {"fields": {field: _origin_content(found[field], nodes) for field in fields}, "nodes": nodes}


def _origin_content(origin: Origin, nodes: dict[str, Any]) -> Any:
    if isinstance(origin, MixedValue):
        factor = _socket_content(origin.mixture.node.inputs[0], nodes)
        return [factor, *(_origin_content(each, nodes) for each in (origin.first, origin.second))]
    return _socket_content(origin.socket, nodes) if origin.name else origin.numbers


def _socket_content(socket: bpy.types.NodeSocket, nodes: dict[str, Any]) -> Any:
    """An input's value, or what it is linked from; the nodes behind it go to `nodes`."""
    link = next((link for link in socket.links if link.is_valid and not link.is_muted), None)
    if link is None:
        value = getattr(socket, "default_value", None)
        return value if value is None or isinstance(value, bool | int | float | str) else list(value)
    node = link.from_node
    if node.name not in nodes:
        nodes[node.name] = None  # so that a ring of links ends
        inputs = {each.identifier: _socket_content(each, nodes) for each in node.inputs if each.is_linked}
        nodes[node.name] = [node_fingerprint(node), inputs]
    return [node.name, link.from_socket.identifier]


def _nodes(
    material: bpy.types.Material, kinds: tuple[str, ...], outputs: Mapping[str, tuple[str, ...]]
) -> list[bpy.types.Node]:
    output = surface_output(material)
    sockets = outputs_behind([output.inputs["Surface"]]) if output else ()
    return [
        each.node
        for each in sockets
        if each.node.bl_idname in kinds or each.name in outputs.get(each.node.bl_idname, ())
    ]


def _mesh_content(item: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> str:
    """A hash of an evaluated mesh with its attributes: UV maps, colours, slots of faces.

    Pairs count to the last bit as the artist made them, and nearly as modifiers make them: see `PAIRS`.
    """
    with evaluated_mesh(item, depsgraph) as mesh:
        content = hashlib.sha256(content_of(mesh))
        for attribute, values in _attributes(mesh):
            is_noisy = attribute.data_type == PAIRS
            content.update(json.dumps([attribute.name, attribute.domain, attribute.data_type]).encode())
            content.update(_steps(values).data if is_noisy else values.data)
        content.update(json.dumps([layer.name for layer in mesh.uv_layers if layer.active_render]).encode())
    if item.type == "MESH":
        for attribute, values in _attributes(item.original.to_mesh()):  # which edit mode has, too
            if attribute.data_type == PAIRS:
                content.update(values.data)
        item.original.to_mesh_clear()
    return content.hexdigest()


def _attributes(mesh: bpy.types.Mesh) -> Iterator[tuple[Any, Array]]:
    """A mesh's attributes that nodes can read, by name, with their values."""
    for attribute in sorted(mesh.attributes, key=lambda each: each.name):
        if not attribute.name.startswith(".") and attribute.data_type in FIELDS:
            field, kind, width = FIELDS[attribute.data_type]
            yield attribute, read_property(attribute.data, field, kind, width)


def _steps(pairs: Array) -> Array:
    """Weighted means of pairs, in steps: see `STEPS`."""
    if not len(pairs):
        return pairs
    begins = np.arange(0, len(pairs), PAIRS_OF_MEAN)
    weights = (np.sqrt(2.0) * np.arange(1, len(pairs) + 1) % 1.0)[:, None]
    means = np.add.reduceat(weights * pairs, begins) / np.add.reduceat(weights, begins)
    steps: Array = np.floor(STEPS * means + 0.3)  # 0 is no border
    return steps


def _object_content(item: bpy.types.Object) -> list[Any]:
    color = [round(number, 6) for number in item.color]
    properties = {name: _plain(value) for name, value in item.items()}
    return [item.name, item.pass_index, color, properties]


def _plain(value: Any) -> Any:
    """A custom property as a JSON value; groups of them count as nothing, as no node reads those."""
    if isinstance(value, bool | int | float | str):
        return value
    return [_plain(each) for each in value.to_list()] if hasattr(value, "to_list") else None
