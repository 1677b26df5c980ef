"""What a bake of a material's inputs depends on beside the material."""

import hashlib
import json
from collections.abc import Mapping
from typing import Any

import bpy
import numpy as np

from .materials import MATRIX_DIGITS, fingerprint, surface_output
from .mesh_arrays import read_property
from .meshes import content_of, evaluated_mesh
from .shape_dependence import outputs_behind

VIEW_NODES = ("ShaderNodeCameraData", "ShaderNodeFresnel", "ShaderNodeLayerWeight", "ShaderNodeLightPath")
VIEW_OUTPUTS = {
    "ShaderNodeNewGeometry": ("Backfacing", "Incoming"),
    "ShaderNodeTexCoord": ("Camera", "Reflection", "Window"),
}
"""Nodes, and outputs of others, that differ between views."""

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


def view_dependence(material: bpy.types.Material) -> str:
    """Names of nodes by which a material differs between views, joined; empty for none."""
    nodes = _nodes(material, VIEW_NODES, VIEW_OUTPUTS)
    return " and ".join(dict.fromkeys(node.bl_label for node in nodes))


def content_for_bakes(
    item: bpy.types.Object, materials: dict[int, bpy.types.Material], depsgraph: bpy.types.Depsgraph
) -> dict[str, Any]:
    """All of an object that a bake of its materials' inputs depends on, to be hashed.

    Parameters
    ----------
    item : bpy.types.Object
    materials : dict of int to bpy.types.Material
        Slot -> the material that is baked.
    depsgraph : bpy.types.Depsgraph
        Evaluated, and holding `item`.

    Returns
    -------
    dict
        JSON values.
    """
    moves = any(_nodes(material, PLACE_NODES, PLACE_OUTPUTS) for material in materials.values())
    return {
        "materials": {slot: fingerprint(material) for slot, material in materials.items()},
        "mesh": _mesh_content(item, depsgraph),
        "object": [item.name, item.pass_index, [round(number, 6) for number in item.color]],
        "properties": {name: _plain(value) for name, value in item.items()},
        "place": np.round(np.array(item.matrix_world), MATRIX_DIGITS).tolist() if moves else None,
        "working_space": bpy.data.colorspace.working_space,
    }


def _nodes(
    material: bpy.types.Material, kinds: tuple[str, ...], outputs: Mapping[str, tuple[str, ...]]
) -> list[bpy.types.Node]:
    output = surface_output(material)
    sockets = outputs_behind([output.inputs["Surface"]], set()) if output else ()
    return [
        each.node
        for each in sockets
        if each.node.bl_idname in kinds or each.name in outputs.get(each.node.bl_idname, ())
    ]


def _mesh_content(item: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> str:
    """A hash of an evaluated mesh with its attributes: UV maps, colours, slots of faces."""
    with evaluated_mesh(item, depsgraph) as mesh:
        content = hashlib.sha256(content_of(mesh))
        for attribute in sorted(mesh.attributes, key=lambda each: each.name):
            if attribute.name.startswith(".") or attribute.data_type not in FIELDS:
                continue
            field, kind, width = FIELDS[attribute.data_type]
            content.update(json.dumps([attribute.name, attribute.domain, attribute.data_type]).encode())
            content.update(read_property(attribute.data, field, kind, width).data)
        content.update(json.dumps([layer.name for layer in mesh.uv_layers if layer.active_render]).encode())
    return content.hexdigest()


def _plain(value: Any) -> Any:
    """A custom property as a JSON value; groups of them count as nothing, as no node reads those."""
    if isinstance(value, bool | int | float | str):
        return value
    return [_plain(each) for each in value.to_list()] if hasattr(value, "to_list") else None
