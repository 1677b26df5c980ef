"""Principled materials described: what of their nodes is a constant or an image, and what is not shown."""

from typing import Any

import bpy

from ..core.errors import SceneError
from ..core.materials.principled import Baked, Bump, Normal, NormalMap, PrincipledInputs, Shading, constant
from .input_nodes import Groups, NotFollowedError, read, source
from .materials import surface_output

INPUTS = {
    "base_color": "Base Color",
    "metallic": "Metallic",
    "roughness": "Roughness",
    "ior": "IOR",
    "specular_level": "Specular IOR Level",
    "specular_tint": "Specular Tint",
    "diffuse_roughness": "Diffuse Roughness",
    "coat_weight": "Coat Weight",
    "coat_roughness": "Coat Roughness",
    "coat_ior": "Coat IOR",
    "coat_tint": "Coat Tint",
    "sheen_weight": "Sheen Weight",
    "sheen_roughness": "Sheen Roughness",
    "sheen_tint": "Sheen Tint",
    "emission_color": "Emission Color",
    "emission_strength": "Emission Strength",
    "alpha": "Alpha",
}
"""Field of `PrincipledInputs`, and of `core.brdf.principled.Principled` -> input of Blender's node."""

NORMAL_INPUTS = {"normal": "Normal", "coat_normal": "Coat Normal"}
"""The same for normals."""

MISSING = {
    "Transmission Weight": "transmission",
    "Subsurface Weight": "subsurface scattering",
    "Anisotropic": "anisotropy",
    "Thin Film Thickness": "thin film",
}
"""Input -> what is not shown, where it is not 0."""


def principled(material: bpy.types.Material) -> PrincipledInputs:
    """Describe a material; nothing changes.

    Parameters
    ----------
    material : bpy.types.Material

    Returns
    -------
    PrincipledInputs

    Raises
    ------
    SceneError
        The material has no surface, or one that is not a single Principled BSDF.
    """
    output = surface_output(material)
    if output is None:
        raise SceneError(
            f"Material {material.name} has no surface: link a shader to the Surface of its Material Output."
        )
    end, groups = source(output.inputs["Surface"], ())
    node = end.node
    if not end.is_output or node.bl_idname != "ShaderNodeBsdfPrincipled":
        raise SceneError(
            f"The surface of material {material.name} is made by {node.name}: link a Principled BSDF alone."
        )
    shading: dict[str, Any] = {field: _shading(node.inputs[name], groups) for field, name in INPUTS.items()}
    normals: dict[str, Any] = {
        field: _normal(node.inputs[name], groups) for field, name in NORMAL_INPUTS.items()
    }
    return PrincipledInputs(
        **shading,
        **normals,
        missing=_missing(output, node, groups),
    )


def _shading(socket: bpy.types.NodeSocket, groups: Groups) -> Shading:
    try:
        return read(socket, groups)
    except NotFollowedError as stop:
        return Baked(stop.reason)


def _missing(output: bpy.types.Node, node: bpy.types.Node, groups: Groups) -> tuple[str, ...]:
    nothing = constant((0.0,))
    of_inputs = [words for name, words in MISSING.items() if _shading(node.inputs[name], groups) != nothing]
    of_outputs = [name.lower() for name in ("Volume", "Displacement") if output.inputs[name].is_linked]
    return (*of_inputs, *of_outputs)


def _normal(socket: bpy.types.NodeSocket, groups: Groups) -> Normal:
    try:
        return _followed_normal(socket, groups)
    except NotFollowedError as stop:
        return Baked(stop.reason)


def _followed_normal(socket: bpy.types.NodeSocket, groups: Groups) -> NormalMap | Bump | None:
    end, groups = source(socket, groups)
    if not end.is_output:
        return None
    node = end.node
    if node.bl_idname == "ShaderNodeNormalMap":
        return _normal_map(node, groups)
    if node.bl_idname == "ShaderNodeBump":
        return _bump(node, groups)
    raise NotFollowedError(node.bl_label)


def _normal_map(node: bpy.types.Node, groups: Groups) -> NormalMap:
    if node.space != "TANGENT" or node.convention != "OPENGL":
        raise NotFollowedError("a normal map that is not OpenGL's in tangent space")
    color, strength = (read(node.inputs[name], groups) for name in ("Color", "Strength"))
    return NormalMap(color, strength, node.uv_map)


def _bump(node: bpy.types.Node, groups: Groups) -> Bump:
    below = _followed_normal(node.inputs["Normal"], groups)
    if isinstance(below, Bump):
        raise NotFollowedError("a bump on a bump")
    height, strength, distance = (
        read(node.inputs[name], groups) for name in ("Height", "Strength", "Distance")
    )
    return Bump(height, strength, distance, node.invert, below)
