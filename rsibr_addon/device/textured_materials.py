"""The program that draws a material whose inputs are textures, and what it reads of one."""

from collections.abc import Iterator, Mapping
from weakref import WeakKeyDictionary

import gpu
import numpy as np

from ..core.conventions import Array
from ..core.errors import ShapeError
from ..core.materials.principled import Bump, Extension, Input, NormalMap, PrincipledInputs, Texture
from . import buffers
from .own_materials import MOST_TEXTURES, DrawnMaterial
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
)
"""Inputs whose numbers come first, as in gpu_shaders/lib/textured_material_lib.glsl."""

NUMBERS = 29
"""Numbers of all inputs, with the color and the strength of a normal map, and a bump's three."""

EXTENSIONS: dict[Extension, str] = {
    "REPEAT": "REPEAT",
    "EXTEND": "EXTEND",
    "CLIP": "CLAMP_TO_BORDER",
    "MIRROR": "MIRRORED_REPEAT",
}
"""What lies outside of an image -> the same in the words of textures."""

NORMAL_MAPPED, BUMPED = 1, 2
"""Bits of what changes the normal."""

_BLACK = Input(((0.0,) * 5,) * 3)
_ZERO = Input(((0.0,) * 5,))


def textured_program(fragment: str, samplers: Mapping[str, str]) -> gpu.types.GPUShader:
    """Build a program that draws `GpuTexturedMesh` with one `DrawnMaterial`.

    Parameters
    ----------
    fragment : str
        The source, which includes lib/textured_material_lib.glsl, without its ending _frag.glsl.
    samplers : mapping of str to str
        Textures of what lights the material, as `mesh_program` takes them.

    Raises
    ------
    DeviceError
        The driver refuses it.
    """
    info = mesh_interface(
        f"struct Material {{ vec4 counts; vec4 rows[{NUMBERS}]; vec4 constants[{NUMBERS}]; "
        f"vec4 mapping[{2 * MOST_TEXTURES}]; }};"
    )
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
            DrawnMaterial, dict[tuple[str, ...], tuple[gpu.types.GPUUniformBuf, tuple[Texture, ...]]]
        ] = WeakKeyDictionary()
        self._nothing: gpu.types.GPUTexture | None = None

    def bind(self, shader: gpu.types.GPUShader, material: DrawnMaterial, uv_maps: tuple[str, ...]) -> None:
        """Set a material's block and images.

        Parameters
        ----------
        shader : GPUShader
            Bound.
        material : DrawnMaterial
        uv_maps : tuple of str
            Those of the mesh that is drawn.

        Raises
        ------
        ShapeError
            It has more than `MOST_TEXTURES` textures.
        """
        made = self._blocks.setdefault(material, {})
        if uv_maps not in made:
            textures = textures_of(material.inputs)
            rows = material_rows(material.inputs, textures, uv_maps)
            made[uv_maps] = gpu.types.GPUUniformBuf(rows.tobytes()), textures
        block, textures = made[uv_maps]
        shader.uniform_block("material", block)
        if self._nothing is None:
            self._nothing = buffers.texture(np.zeros((1, 1, 4), np.float32))
        for number in range(MOST_TEXTURES):
            image = self._nothing
            if number < len(textures):
                image = _placed(material.textures[textures[number]], textures[number])
            shader.uniform_sampler(f"image_{number}", image)


def _placed(image: gpu.types.GPUTexture, texture: Texture) -> gpu.types.GPUTexture:
    """The image, looked up as the texture asks for; Blender's own draws say each time how they do."""
    image.extend_mode(EXTENSIONS[texture.extension])
    image.filter_mode(not texture.closest)
    # Mesa's software driver blurs what is looked up so, four times as slowly
    image.anisotropic_filter(False)
    return image


def textures_of(inputs: PrincipledInputs) -> tuple[Texture, ...]:
    """The textures that a material samples, each once; a bump's height, which is sampled around, first."""
    used = (each.texture for each in _inputs(inputs) if each.texture)
    height = _bump(inputs).height.texture if isinstance(inputs.normal, Bump) else None
    return tuple(dict.fromkeys([*filter(None, [height]), *used]))


def material_rows(inputs: PrincipledInputs, textures: tuple[Texture, ...], uv_maps: tuple[str, ...]) -> Array:
    """A material as gpu_shaders/lib/textured_material_lib.glsl reads it.

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
        The number of textures, and what changes the normal; of each number the factors of a texel; its
        constant, and its texture's number or -1; of each texture two rows of its mapping, the first with the
        number of its UV map or -1.

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
    factors, constants = np.zeros((2, NUMBERS, 4), np.float32)
    row = 0
    for value in _inputs(inputs):
        number = textures.index(value.texture) if value.texture else -1
        for *of_texel, added in value.rows:
            factors[row], constants[row, :2] = of_texel, (added, number)
            row += 1
    mapping = np.zeros((MOST_TEXTURES, 2, 4), np.float32)
    for texture, rows in zip(textures, mapping, strict=False):
        rows[:, :3] = np.reshape(texture.mapping, (2, 3))
        named = texture.uv_map or next(iter(uv_maps), "")
        rows[0, 3] = uv_maps.index(named) if named in uv_maps else -1
    bump = isinstance(inputs.normal, Bump)
    mapped = isinstance(inputs.normal, NormalMap) or (bump and _bump(inputs).normal is not None)
    counts = np.array([[len(textures), mapped * NORMAL_MAPPED + bump * BUMPED, 0.0, 0.0]], np.float32)
    return np.concatenate([counts, factors, constants, mapping.reshape(-1, 4)])


def _bump(inputs: PrincipledInputs) -> Bump:
    """A material's bump; a flat one where it has none."""
    if isinstance(inputs.normal, Bump):
        return inputs.normal
    below = inputs.normal if isinstance(inputs.normal, NormalMap) else None
    return Bump(_ZERO, _ZERO, _ZERO, normal=below)


def _inputs(inputs: PrincipledInputs) -> Iterator[Input]:
    """All inputs in the block's order.

    Raises
    ------
    ShapeError
        One is still to be baked.
    """
    bump = _bump(inputs)
    flat = bump.normal or NormalMap(_BLACK, _ZERO)
    steps = bump.height.texture is not None and bump.height.texture.closest
    height = _ZERO if steps else bump.height  # within a texel it is flat
    values = (getattr(inputs, name) for name in INPUTS)
    for value in (*values, flat.color, flat.strength, height, bump.strength, _signed_distance(bump)):
        if not isinstance(value, Input):
            raise ShapeError(
                f"An input of the material is still to be baked ({value.reason}): bake it first."
            )
        yield value


def _signed_distance(bump: Bump) -> Input:
    sign = -1.0 if bump.invert else 1.0
    rows = tuple((sign * r, sign * g, sign * b, sign * a, sign * e) for r, g, b, a, e in bump.distance.rows)
    return Input(rows, bump.distance.texture)
