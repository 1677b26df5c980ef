"""Principled materials described: what of their nodes is a constant or an image, and what is not shown."""

from dataclasses import replace
from typing import Any

import bpy

from ..core.materials.principled import (
    Baked,
    Bump,
    Input,
    Normal,
    NormalMap,
    PrincipledInputs,
    Shading,
    constant,
)
from ..core.materials.stand_ins import PLAIN
from .input_nodes import Groups, NotFollowedError, Read, Reading, mixed, source
from .materials import surface_output
from .surfaces import (
    MISSING,
    NORMAL_INPUTS,
    MixedValue,
    Mixture,
    Origin,
    Surface,
    leaves,
    origins,
    surface_of,
)

SHAPES = (
    "roughness",
    "diffuse_roughness",
    "coat_roughness",
    "specular_level",
    "ior",
    "normal",
    "coat_normal",
)
"""Fields that reflection is not linear in."""

THIN = "total reflection, which its IOR below 1 asks for"

SEPARATE = "the highlights of mixed shaders, but for one highlight between them"


def principled(material: bpy.types.Material) -> PrincipledInputs:
    """Describe a material; nothing changes.

    Parameters
    ----------
    material : bpy.types.Material

    Returns
    -------
    PrincipledInputs
        Of the Principled BSDF that is its surface, or that stands for it: see `surfaces.origins`.

    Raises
    ------
    SceneError
        The material has no surface, or one that no Principled BSDF can stand for.
    """
    surface = surface_of(material)
    reading = _FieldReading()
    found: dict[str, Any] = {field: reading.of(field, each) for field, each in origins(surface).items()}
    if isinstance(surface, Mixture):  # Cycles bakes what shaders have by their mix, which has one value
        found = {
            field: replace(value, apart=True) if isinstance(value, Baked) else value
            for field, value in found.items()
        }
    described = replace(PLAIN, **found)
    missing = [*_missing(material, surface, reading), *([SEPARATE] if reading.is_between else [])]
    missing += [THIN] if _is_thin(described) else []
    return replace(described, missing=tuple(dict.fromkeys(missing)))


def _is_thin(inputs: PrincipledInputs) -> bool:
    """Whether the boundary may lead into what is thinner than air, which a metal does not have."""
    is_metal = isinstance(inputs.metallic, Input) and inputs.metallic.least[0] >= 1.0
    return isinstance(inputs.ior, Input) and inputs.ior.least[0] < 1.0 and not is_metal


class _FieldReading:
    """Reads fields from where they come from.

    Attributes
    ----------
    is_between : bool
        Whether shaders are mixed that reflect otherwise than one between them.
    """

    def __init__(self) -> None:
        self._reading = Reading()
        self._halves: set[str] = set()

    @property
    def is_between(self) -> bool:
        """See the class: a mix of metallic is exact if its base colour is one."""
        return bool(self._halves.intersection(SHAPES)) or {"metallic", "base_color"} <= self._halves

    def of(self, field: str, origin: Origin) -> Shading | Normal:
        """What a field is."""
        if isinstance(origin, MixedValue):
            return self._mixed(field, origin)
        if not origin.name:
            return constant(origin.numbers)
        read_one = self._normal if field in NORMAL_INPUTS else self.shading
        return read_one(origin.socket, origin.leaf.groups)

    def shading(self, socket: bpy.types.NodeSocket, groups: Groups) -> Shading:
        """What an input is."""
        try:
            return self._reading.of(socket, groups)
        except NotFollowedError as stop:
            return Baked(stop.reason)

    def _normal(self, socket: bpy.types.NodeSocket, groups: Groups) -> Normal:
        try:
            return _followed_normal(socket, groups, self._reading.of)
        except NotFollowedError as stop:
            return Baked(stop.reason)

    def _mixed(self, field: str, origin: MixedValue) -> Shading | Normal:
        first, second = self.of(field, origin.first), self.of(field, origin.second)
        if first == second and not isinstance(first, Baked):
            return first
        factor = self.shading(origin.mixture.node.inputs[0], origin.mixture.groups)
        if isinstance(factor, Input) and not factor.texture:
            if factor.constant[0] <= 0.0:
                return first
            if factor.constant[0] >= 1.0:
                return second
            self._halves.add(field)
        if not (isinstance(first, Input) and isinstance(second, Input) and isinstance(factor, Input)):
            return Baked("a mix of shaders")
        try:
            return mixed(first, second, factor)
        except NotFollowedError as stop:
            return Baked(stop.reason)


def _missing(material: bpy.types.Material, surface: Surface, reading: _FieldReading) -> list[str]:
    """What is not shown of a material's shaders and outputs."""
    nothing = constant((0.0,))
    missing = []
    for leaf in leaves(surface):
        named = {name: words for name, words in MISSING.items() if name in leaf.node.inputs}
        missing += [
            words
            for name, words in named.items()
            if reading.shading(leaf.node.inputs[name], leaf.groups) != nothing
        ]
        if leaf.node.bl_idname == "ShaderNodeBsdfTransparent":
            color = reading.shading(leaf.node.inputs["Color"], leaf.groups)
            missing += ["tinted transparency"] if color != constant((1.0, 1.0, 1.0)) else []
    output = surface_output(material)
    missing += [
        name.lower() for name in ("Volume", "Displacement") if output and output.inputs[name].is_linked
    ]
    return missing


def _followed_normal(socket: bpy.types.NodeSocket, groups: Groups, read: Read) -> NormalMap | Bump | None:
    end, groups = source(socket, groups)
    if not end.is_output:
        return None
    node = end.node
    if node.bl_idname == "ShaderNodeNormalMap":
        return _normal_map(node, groups, read)
    if node.bl_idname == "ShaderNodeBump":
        return _bump(node, groups, read)
    raise NotFollowedError(node.bl_label)


def _normal_map(node: bpy.types.Node, groups: Groups, read: Read) -> NormalMap:
    if node.space != "TANGENT" or node.convention != "OPENGL":
        raise NotFollowedError("a normal map that is not OpenGL's in tangent space")
    color, strength = (read(node.inputs[name], groups) for name in ("Color", "Strength"))
    return NormalMap(color, strength, node.uv_map)


def _bump(node: bpy.types.Node, groups: Groups, read: Read) -> Bump:
    below = _followed_normal(node.inputs["Normal"], groups, read)
    if isinstance(below, Bump):
        raise NotFollowedError("a bump on a bump")
    height, strength, distance = (
        read(node.inputs[name], groups) for name in ("Height", "Strength", "Distance")
    )
    return Bump(height, strength, distance, node.invert, below)
