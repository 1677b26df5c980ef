"""The shaders that a material's surface is made of, and where one Principled BSDF's inputs come from."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import bpy
import numpy as np

from ..core.brdf.fresnel import fresnel_conductor
from ..core.brdf.fresnel_powers import edge_of
from ..core.errors import SceneError
from .input_nodes import Groups, NotFollowedError, Reading, source
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

EMISSION = ("emission_color", "emission_strength")

MISSING = {
    "Transmission Weight": "transmission",
    "Subsurface Weight": "subsurface scattering",
    "Anisotropic": "anisotropy",
    "Anisotropy": "anisotropy",
    "Thin Film Thickness": "thin film",
}
"""Input of a shader -> what is not shown, where it is not 0."""


@dataclass(frozen=True)
class Shader:
    """What a node is as a Principled BSDF.

    Attributes
    ----------
    inputs : mapping of str to str
        Field of `PrincipledInputs` -> input of the node.
    fixed : mapping of str to tuple of float
        Field -> its numbers, where no input has them. A field in neither does not matter: what the shader is
        mixed with decides.
    """

    inputs: Mapping[str, str]
    fixed: Mapping[str, tuple[float, ...]] = field(default_factory=dict)


_BARE = {"coat_weight": (0.0,), "sheen_weight": (0.0,), "alpha": (1.0,)}
_UNLIT = {**_BARE, "emission_strength": (0.0,)}
_DULL = {"metallic": (0.0,), "specular_level": (0.0,)}
_BLACK = {**_BARE, **_DULL, "base_color": (0.0, 0.0, 0.0)}

SHADERS = {
    "ShaderNodeBsdfPrincipled": Shader({**INPUTS, **NORMAL_INPUTS}),
    "ShaderNodeBsdfDiffuse": Shader(
        {"base_color": "Color", "diffuse_roughness": "Roughness", "normal": "Normal"}, {**_UNLIT, **_DULL}
    ),
    "ShaderNodeBsdfAnisotropic": Shader(
        {"base_color": "Color", "roughness": "Roughness", "normal": "Normal"}, {**_UNLIT, "metallic": (1.0,)}
    ),
    "ShaderNodeBsdfMetallic": Shader(
        {
            "base_color": "Base Color",
            "specular_tint": "Edge Tint",
            "roughness": "Roughness",
            "normal": "Normal",
        },
        {**_UNLIT, "metallic": (1.0,)},
    ),
    "ShaderNodeEmission": Shader({"emission_color": "Color", "emission_strength": "Strength"}, _BLACK),
    "ShaderNodeBsdfTransparent": Shader({}, {"alpha": (0.0,)}),
}
"""Type of node -> what it is; `_values` knows more of some."""

FLATTEST = 20.0 / 3.0
"""Tint of a Glossy BSDF's edge, as a share of what is missing to white: the x of the least squares over the
hemisphere of (1 - c)^5 - x c (1 - c)^6, by which Schlick's rise at the edge is all but undone."""

MIDDLE = 0.5
"""The colour for which that is done where an image says it."""


@dataclass(frozen=True)
class Leaf:
    """A shader, and the groups that its node lies in."""

    node: bpy.types.Node
    groups: Groups


@dataclass(frozen=True)
class Mixture:
    """Two surfaces, mixed or added.

    Attributes
    ----------
    node : bpy.types.Node
        Mix Shader or Add Shader.
    groups : Groups
        What that lies in.
    first, second : Leaf or Mixture
    """

    node: bpy.types.Node
    groups: Groups
    first: "Surface"
    second: "Surface"


Surface = Leaf | Mixture


@dataclass(frozen=True)
class Value:
    """A field's value as one shader has it.

    Attributes
    ----------
    leaf : Leaf
    name : str
        The input of its node; empty for a fixed one.
    numbers : tuple of float
        Those of a fixed one.
    """

    leaf: Leaf
    name: str = ""
    numbers: tuple[float, ...] = ()

    @property
    def socket(self) -> bpy.types.NodeSocket:
        """The input."""
        socket: bpy.types.NodeSocket = self.leaf.node.inputs[self.name]
        return socket


@dataclass(frozen=True)
class MixedValue:
    """A field's values as two surfaces have them, mixed as these are."""

    mixture: Mixture
    first: "Origin"
    second: "Origin"


Origin = Value | MixedValue


def surface_of(material: bpy.types.Material) -> Surface:
    """The shaders that a material's surface is made of.

    Raises
    ------
    SceneError
        The material has no surface, or one with a shader that no Principled BSDF can stand for.
    """
    output = surface_output(material)
    if output is None:
        raise SceneError(
            f"Material {material.name} has no surface: link a shader to the Surface of its Material Output."
        )
    return _surface(output.inputs["Surface"], (), material.name)


def leaves(surface: Surface) -> list[Leaf]:
    """Its shaders."""
    return [surface] if isinstance(surface, Leaf) else [*leaves(surface.first), *leaves(surface.second)]


def is_in_group(surface: Surface) -> bool:
    """Whether a shader, or a mix of some, lies in a group."""
    if isinstance(surface, Leaf):
        return bool(surface.groups)
    return bool(surface.groups) or is_in_group(surface.first) or is_in_group(surface.second)


def origins(surface: Surface) -> dict[str, Origin]:
    """Where the inputs of the one Principled BSDF come from that stands for a surface.

    Returns
    -------
    dict
        Field of `PrincipledInputs` -> where its value comes from. A field that is not there does not matter.

    Raises
    ------
    SceneError
        Two reflections are added, which no Principled BSDF does.

    Notes
    -----
    A mix of shaders is taken as the shader of mixed inputs. This is exact where its factor is 0 or 1, where
    the two differ in what reflection is linear in (base colour, metallic with the same base colour, emission,
    alpha), and near to it otherwise.
    """
    if isinstance(surface, Leaf):
        return _values(surface)
    first, second = origins(surface.first), origins(surface.second)
    if surface.node.bl_idname == "ShaderNodeAddShader":
        return _added(surface, first, second)
    if (index := _index_of(surface)) is not None:
        return _boundary(surface, index, first, second)
    both = first.keys() & second.keys()
    return {**first, **second, **{name: MixedValue(surface, first[name], second[name]) for name in both}}


def _surface(socket: bpy.types.NodeSocket, groups: Groups, name: str) -> Surface:
    try:
        end, groups = source(socket, groups)
    except NotFollowedError as stop:
        raise SceneError(f"The surface of material {name} is {stop.reason}: link a shader.") from stop
    node = end.node
    kind = node.bl_idname if end.is_output else ""
    if kind in SHADERS:
        return Leaf(node, groups)
    if kind in ("ShaderNodeMixShader", "ShaderNodeAddShader"):
        shaders = [each for each in node.inputs if each.type == "SHADER"]
        first, second = (_surface(each, groups, name) for each in shaders)
        return Mixture(node, groups, first, second)
    made = f"made by {node.name}" if kind else "mixed with nothing"
    raise SceneError(
        f"The surface of material {name} is {made}: use Principled, Diffuse, Glossy, Metallic, Emission or "
        f"Transparent BSDFs, or mixes of them."
    )


def _values(leaf: Leaf) -> dict[str, Origin]:
    shader, node = SHADERS[leaf.node.bl_idname], leaf.node
    fixed = dict(shader.fixed)
    if node.bl_idname == "ShaderNodeBsdfAnisotropic":
        fixed["specular_tint"] = _even_tint(_constant(leaf, "Color") or (MIDDLE,) * 3)
    if node.bl_idname == "ShaderNodeBsdfMetallic" and node.fresnel_type == "PHYSICAL_CONDUCTOR":
        fixed |= _conductor(leaf)
    named: dict[str, Origin] = {
        field: Value(leaf, name) for field, name in shader.inputs.items() if field not in fixed
    }
    if "emission_strength" in named and _constant(leaf, shader.inputs["emission_strength"]) == (0.0,):
        del named["emission_color"]
    return {**named, **{field: Value(leaf, numbers=numbers) for field, numbers in fixed.items()}}


def _constant(leaf: Leaf, name: str) -> tuple[float, ...] | None:
    """The numbers of an input; None where they differ from place to place."""
    try:
        value = Reading().of(leaf.node.inputs[name], leaf.groups)
    except NotFollowedError:
        return None
    return None if value.texture else value.constant


def _even_tint(color: tuple[float, ...]) -> tuple[float, ...]:
    """The tint of a metal's edge with which it reflects about as much from all sides."""
    f0 = np.clip(color, 0.0, 1.0)
    whole = np.maximum(edge_of(f0, 0.0), 1e-6)
    return tuple(np.clip(1.0 - FLATTEST * (1.0 - f0) / whole, 0.0, 1.0).tolist())


def _conductor(leaf: Leaf) -> dict[str, tuple[float, ...]]:
    """Colour and tint of a metal by its index and extinction, right at normal incidence and at 82 degrees."""
    index, extinction = (_constant(leaf, name) for name in ("IOR", "Extinction"))
    if index is None or extinction is None:
        raise SceneError(
            f"{leaf.node.name} has an index of refraction from an image: use its F82 Tint instead."
        )
    f0, at_82 = (
        fresnel_conductor(np.full(3, cosine), np.array(index), np.array(extinction))
        for cosine in (1.0, 1.0 / 7.0)
    )
    tint = np.clip(at_82 / (f0 + (1.0 - f0) * (6.0 / 7.0) ** 5), 0.0, 1.0)
    return {"base_color": tuple(f0.tolist()), "specular_tint": tuple(tint.tolist())}


def _added(mixture: Mixture, first: dict[str, Origin], second: dict[str, Origin]) -> dict[str, Origin]:
    """A surface with the light that another gives off."""
    for surface, lit, unlit in ((mixture.first, first, second), (mixture.second, second, first)):
        gives_off = all(each.node.bl_idname == "ShaderNodeEmission" for each in leaves(surface))
        if gives_off and "emission_color" not in unlit:
            return {**unlit, **{name: lit[name] for name in EMISSION if name in lit}}
    raise SceneError(
        f"{mixture.node.name} adds two shaders that reflect or give off light, as no Principled BSDF does: "
        f"use a Mix Shader."
    )


def _index_of(mixture: Mixture) -> float | None:
    """The index of refraction of a mix of diffuse and glossy reflection by a Fresnel term; else None."""
    kinds = [each.node.bl_idname for each in (mixture.first, mixture.second)]
    if kinds != ["ShaderNodeBsdfDiffuse", "ShaderNodeBsdfAnisotropic"]:
        return None
    try:
        end, groups = source(mixture.node.inputs[0], mixture.groups)
    except NotFollowedError:
        return None
    kind = end.node.bl_idname if end.is_output else ""
    if kind == "ShaderNodeFresnel":
        found = _constant(Leaf(end.node, groups), "IOR")
        return max(found[0], 1.0) if found else None
    if kind == "ShaderNodeLayerWeight" and end.identifier == "Fresnel":
        found = _constant(Leaf(end.node, groups), "Blend")
        return 1.0 / max(1.0 - found[0], 1e-5) if found else None
    return None


def _boundary(
    mixture: Mixture, index: float, diffuse: dict[str, Origin], glossy: dict[str, Origin]
) -> dict[str, Origin]:
    """A dielectric boundary above a diffuse base."""
    leaf = leaves(mixture.second)[0]
    return {
        **diffuse,
        "roughness": glossy["roughness"],
        "specular_tint": Value(leaf, "Color"),
        "ior": Value(leaf, numbers=(index,)),
        "specular_level": Value(leaf, numbers=(0.5,)),
    }
