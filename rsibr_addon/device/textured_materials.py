"""The program that draws a material whose inputs are textures, and what it reads of one."""

from collections.abc import Collection, Iterator, Mapping
from contextlib import contextmanager
from typing import Any
from weakref import WeakKeyDictionary

import gpu
import numpy as np

from ..core.conventions import Array
from ..core.errors import ShapeError
from ..core.materials.principled import (
    Baked,
    Bump,
    Extension,
    Input,
    Normal,
    NormalMap,
    PrincipledInputs,
    Texture,
)
from . import buffers
from .own_materials import MOST_TEXTURES, TRANSLUCENT, DrawnMaterial
from .shaders import build, mesh_interface

INPUTS = (
    "base_color",
    "metallic",
    "roughness",
    "ior",
    "specular_level",
    "specular_tint",
    "diffuse_roughness",
    "coat_weight",
    "coat_roughness",
    "coat_ior",
    "coat_tint",
    "emission_color",
    "emission_strength",
    "alpha",
    "sheen_weight",
    "sheen_roughness",
    "sheen_tint",
)
"""Inputs whose numbers come first, as in gpu_shaders/principled_textured_frag.glsl."""

NUMBERS = 40
"""Numbers of all inputs, and room up to a multiple of 4: after `INPUTS` a normal map's color and strength,
a bump's strength and distance, and color and strength of the coat's normal map."""

MATERIAL_STRUCT = (
    f"struct Material {{ vec4 counts; vec4 antialiasing; vec4 height; vec4 constants[{NUMBERS // 4}]; "
    f"vec4 rows[{NUMBERS + 1}]; vec4 targets[{NUMBERS + 1}]; "
    f"vec4 ranges[{MOST_TEXTURES}]; vec4 mapping[{2 * MOST_TEXTURES}]; }};"
)
"""A material in the shader: see `material_rows`."""

EXTENSIONS: dict[Extension, str] = {
    "REPEAT": "REPEAT",
    "EXTEND": "EXTEND",
    "CLIP": "CLAMP_TO_BORDER",
    "MIRROR": "MIRRORED_REPEAT",
}
"""What lies outside of an image -> the same in the words of textures."""

NORMAL_MAPPED, BUMPED, COAT_LIKE_BASE, COAT_NORMAL_MAPPED = 1, 2, 4, 8
"""Bits of what changes the normal, and the coat's."""

_BLACK = Input(((0.0,) * 5,) * 3)
_ZERO = Input(((0.0,) * 5,))


NORMALS = "NORMALS"
"""Defined by a program that draws the normals of a material instead, where its alpha is a half or more."""


def textured_program(
    fragment: str, samplers: Mapping[str, str], defines: Collection[str]
) -> gpu.types.GPUShader:
    """Build a program that draws `GpuTexturedMesh` with one `DrawnMaterial`.

    Parameters
    ----------
    fragment : str
        The source, without its ending _frag.glsl.
    samplers : mapping of str to str
        Textures of what lights the material, as `MeshProgram` takes them.
    defines : collection of str
        What is defined: `NORMALS`, or see `DrawnMaterial.defines`.

    Raises
    ------
    DeviceError
        The driver refuses it.
    """
    info = mesh_interface(MATERIAL_STRUCT)
    for each in defines:
        info.define(*each.split())
    if TRANSLUCENT in defines:
        info.push_constant("FLOAT", "whole")
    info.uniform_buf(1, "Material", "material")
    info.vertex_in(2, "VEC4", "tangent")
    info.vertex_in(3, "VEC4", "uv_a")
    info.vertex_in(4, "VEC4", "uv_b")
    varyings = gpu.types.GPUStageInterfaceInfo("rsibr_textured")
    varyings.smooth("VEC3", "object_normal")
    varyings.smooth("VEC4", "object_tangent")
    varyings.smooth("VEC4", "uv_01")
    varyings.smooth("VEC4", "uv_23")
    info.vertex_out(varyings)
    images = {f"image_{number}": "FLOAT_2D" for number in range(MOST_TEXTURES)}
    for slot, (name, sampler_type) in enumerate({**samplers, **images}.items()):
        info.sampler(slot, sampler_type, name)
    return build(fragment, info, "textured_mesh_vert.glsl", f"{fragment}_frag.glsl")


class MaterialBinding:
    """Binds materials to programs of `textured_program`; what it makes of one is kept as long as that is."""

    def __init__(self) -> None:
        self._blocks: WeakKeyDictionary[
            DrawnMaterial, dict[tuple[Any, ...], tuple[gpu.types.GPUUniformBuf, tuple[Texture, ...]]]
        ] = WeakKeyDictionary()
        self._nothing: gpu.types.GPUTexture | None = None

    @contextmanager
    def bound(
        self,
        shader: gpu.types.GPUShader,
        material: DrawnMaterial,
        uv_maps: tuple[str, ...],
        antialiased: bool,
    ) -> Iterator[None]:
        """Within, a program draws with a material; Blender's images are looked up as before afterwards.

        Parameters
        ----------
        shader : GPUShader
            Bound.
        material : DrawnMaterial
        uv_maps : tuple of str
            Those of the mesh that is drawn.
        antialiased : bool
            See `OwnMaterials`.

        Raises
        ------
        ShapeError
            It has more than `MOST_TEXTURES` textures.
        """
        # Blender may load an image anew in another format
        formats = tuple(texture.format for texture in material.textures.values())
        made, key = self._blocks.setdefault(material, {}), (uv_maps, antialiased, formats)
        if key not in made:
            rows, textures = drawn_rows(material, uv_maps, antialiased)
            made[key] = gpu.types.GPUUniformBuf(rows.tobytes()), textures
        block, textures = made[key]
        shader.uniform_block("material", block)
        if self._nothing is None:
            self._nothing = buffers.texture(np.zeros((1, 1, 4), np.float32))
        images = [material.textures[texture] for texture in textures]
        try:
            for number in range(MOST_TEXTURES):
                image = self._nothing
                if number < len(images):
                    image = images[number]
                    image.extend_mode(EXTENSIONS[textures[number].extension])
                    image.filter_mode(not textures[number].closest)
                    # Mesa's software driver blurs what is looked up so
                    image.anisotropic_filter(False)
                shader.uniform_sampler(f"image_{number}", image)
            yield
        finally:
            for image in images:
                image.extend_mode("REPEAT")
                image.filter_mode(True)
                image.anisotropic_filter(True)


def drawn_rows(
    material: DrawnMaterial, uv_maps: tuple[str, ...], antialiased: bool
) -> tuple[Array, tuple[Texture, ...]]:
    """A material as the shader reads it, with its antialiasing, and the textures that it samples, in turn.

    Parameters and errors are those of `MaterialBinding.bound`, rows those of `material_rows`.
    """
    textures = textures_of(material.inputs)
    rows = material_rows(material.inputs, textures, uv_maps)
    rows[1] = _antialiasing(material, textures, antialiased)
    return rows, textures


def textures_of(inputs: PrincipledInputs) -> tuple[Texture, ...]:
    """The textures that a material samples, each once.

    A bump's height comes first, then a normal map's color; what is premultiplied of the others comes last.
    """
    normal = _normal_map(inputs.normal)
    first = [_bump(inputs).height, *([normal.color] if normal else [])]
    others = sorted(_inputs(inputs), key=lambda each: bool(each.texture and each.texture.is_premultiplied))
    return tuple(dict.fromkeys(each.texture for each in [*first, *others] if each.texture))


def material_rows(inputs: PrincipledInputs, textures: tuple[Texture, ...], uv_maps: tuple[str, ...]) -> Array:
    """A material as gpu_shaders/principled_textured_frag.glsl reads it.

    Parameters
    ----------
    inputs : PrincipledInputs
    textures : tuple of Texture
        See `textures_of`.
    uv_maps : tuple of str
        Of the mesh; the first is the one that it renders with.

    Returns
    -------
    ndarray, shape (n, 4), float32
        The number of textures, and what changes the normal; a row for antialiasing; the factors of a texel in
        a bump's height; the constants of all numbers; the factors of those that have a texture, texture by
        texture, and which numbers these are; the ranges of textures in these rows; of each texture two rows
        of its mapping, the first with the number of its UV map or -1, the second with 0, with 1 where it is
        covered, or with 2 where its texels are interpolated too.

    Raises
    ------
    ShapeError
        There are more than `MOST_TEXTURES` textures.
    """
    if len(textures) > MOST_TEXTURES:
        raise ShapeError(
            f"A material samples {len(textures)} textures, and previews take {MOST_TEXTURES}: "
            f"bake some of its inputs."
        )
    numbered = [(row, value.texture) for value in _inputs(inputs) for row in value.rows]
    constants = np.zeros(NUMBERS, np.float32)
    constants[: len(numbered)] = [row[4] for row, _ in numbered]
    # The last one adds nothing, for a texture of no number, as that of a bump's height
    factors, targets = np.zeros((2, NUMBERS + 1, 4), np.float32)
    ranges = np.zeros((MOST_TEXTURES, 4), np.float32)
    end = 0
    for texture, begin_and_end in zip(textures, ranges, strict=False):
        begin_and_end[0] = end
        for number, (row, of_row) in enumerate(numbered):
            if of_row == texture:
                factors[end], targets[end, 0] = row[:4], number
                end += 1
        begin_and_end[1] = end
        if begin_and_end[0] == end:
            begin_and_end[:2] = NUMBERS, NUMBERS + 1
    mapping = np.zeros((MOST_TEXTURES, 2, 4), np.float32)
    for texture, rows in zip(textures, mapping, strict=False):
        rows[:, :3] = np.reshape(texture.mapping, (2, 3))
        named = texture.uv_map or next(iter(uv_maps), "")
        rows[1, 3] = texture.covered * (1 if texture.closest else 2)
        rows[0, 3] = uv_maps.index(named) if named in uv_maps else -1
    counts = np.array([len(textures), _changes(inputs), 0.0, 0.0], np.float32)
    parts = (
        counts,
        np.zeros(4, np.float32),
        _height_factors(_bump(inputs)),
        constants,
        factors,
        targets,
        ranges,
        mapping,
    )
    return np.concatenate([part.reshape(-1, 4) for part in parts])


def _changes(inputs: PrincipledInputs) -> int:
    """What changes the normals, as bits."""
    changes = NORMAL_MAPPED if _normal_map(inputs.normal) else 0
    changes |= BUMPED if isinstance(inputs.normal, Bump) else 0
    if inputs.coat_normal is not None and inputs.coat_normal == inputs.normal:
        return changes | COAT_LIKE_BASE
    return changes | (COAT_NORMAL_MAPPED if _normal_map(inputs.coat_normal) else 0)


def _antialiasing(material: DrawnMaterial, textures: tuple[Texture, ...], antialiased: bool) -> Array:
    """Whether there is any; of a normal map the error of a texel's length, and its texture's number or -1."""
    normal = _normal_map(material.inputs.normal)
    texture = normal.color.texture if normal else None
    if texture is None:
        return np.array([antialiased, 0.0, -1.0, 0.0])
    is_coarse = material.textures[texture].format in ("RGBA8", "SRGB8_A8", "R8", "RG8")
    return np.array([antialiased, is_coarse / 255.0, textures.index(texture), 0.0])


def _height_factors(bump: Bump) -> Array:
    """Factors of a texel in a bump's height; 0 where it is flat within a texel."""
    texture = bump.height.texture
    is_flat = texture is None or texture.closest
    return np.zeros(4, np.float32) if is_flat else np.array(bump.height.rows[0][:4], np.float32)


def _bump(inputs: PrincipledInputs) -> Bump:
    """A material's bump; a flat one where it has none."""
    return inputs.normal if isinstance(inputs.normal, Bump) else Bump(_ZERO, _ZERO, _ZERO)


def _normal_map(normal: Normal) -> NormalMap | None:
    """A normal's map, or that which a bump lies on."""
    below = normal.normal if isinstance(normal, Bump) else normal
    return below if isinstance(below, NormalMap) else None


def _inputs(inputs: PrincipledInputs) -> Iterator[Input]:
    """All inputs in the block's order.

    Raises
    ------
    ShapeError
        One is still to be baked.
    """
    bump, none = _bump(inputs), NormalMap(_BLACK, _ZERO)
    base, coat = (_normal_map(each) or none for each in (inputs.normal, inputs.coat_normal))
    of_normals = base.color, base.strength, bump.strength, _signed_distance(bump), coat.color, coat.strength
    values = (getattr(inputs, name) for name in INPUTS)
    stand_ins = (each for each in (inputs.normal, inputs.coat_normal) if isinstance(each, Baked))
    for value in (*stand_ins, *values, *of_normals):
        if not isinstance(value, Input):
            raise ShapeError(
                f"An input of the material is still to be baked ({value.reason}): bake it first."
            )
        yield value


def _signed_distance(bump: Bump) -> Input:
    sign = -1.0 if bump.invert else 1.0
    rows = tuple((sign * r, sign * g, sign * b, sign * a, sign * e) for r, g, b, a, e in bump.distance.rows)
    return Input(rows, bump.distance.texture)
