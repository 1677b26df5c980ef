"""A pyramid of kernels and the families of lobes on the GPU: one pass over a mesh of a Principled material.

Blender's `gpu` module cannot fill the mips of a texture, so the pyramid's maps lie in one picture.
"""

import gpu
import numpy as np

from ...core.brdf.fresnel_powers import rise, rise_table
from ...core.brdf.principled import Surface
from ...core.conventions import Array
from ...core.errors import ShapeError
from ...core.half_floats import half_holds
from ...core.kinds.kernel_pyramid.atlas import atlas_texels
from ...core.kinds.kernel_pyramid.look import PrincipledLook
from ...core.kinds.kernel_pyramid.pyramid import Pyramid
from ...core.kinds.kernel_pyramid.shading import Families
from ...core.kinds.kernel_pyramid.split_sum import split_families
from ...core.lobes.family import KERNELS, Family
from ..drawing import Draw, GpuMesh, Inputs, ProgramMapSet
from ..own_materials import OwnMaterials
from ..shaders import MeshProgram, kept_until_exit
from ..textured_materials import TRANSLUCENT, MaterialBinding, textured_program
from ..textured_mesh import GpuTexturedMesh
from ..textures import GpuTexture

GGX_LOBES, LEANING_LOBES = 4, 2
"""Lobes of families, as gpu_shaders/lib/principled_radiance_lib.glsl has them; a texel has four numbers."""

GLASS = rise(0.2)[1:] / rise(0.2)[1]
"""Rising powers of glass, of an index of 1.5, over the first of them.

Most coats and plastics are glass: their weights are a function of their own, in the place of the first rising
one, which metals do not have. So glass costs two lookups of weights, as does a metal without tinted edges.
"""

_WIDTHS_AN_OCTAVE = 4
"""As gpu_shaders/lib/family_lib.glsl has it."""

SAMPLERS = {
    "atlas": "FLOAT_2D",
    "places": "FLOAT_2D",
    "ggx": "FLOAT_2D_ARRAY",
    "leaning": "FLOAT_2D_ARRAY",
    "albedos": "FLOAT_2D_ARRAY",
    "rises": "FLOAT_2D",
}
"""Name of each of a pyramid's textures, in their order -> its type."""

principled_shader = MeshProgram(
    "principled",
    "PrincipledLook look",
    "vec4 base; vec4 specular; vec4 coat; vec4 emission; vec4 boundary; vec4 coating;",
    SAMPLERS,
)
"""Draws a mesh of one Principled material, the same all over."""


@kept_until_exit
def opaque_shader() -> gpu.types.GPUShader:
    """Draws triangles of an opaque material whose inputs are textures."""
    return textured_program("principled_textured", SAMPLERS)


@kept_until_exit
def translucent_shader() -> gpu.types.GPUShader:
    """The same of a material that covers in part, or has holes."""
    return textured_program("principled_textured", SAMPLERS, TRANSLUCENT)


class GpuPyramid(ProgramMapSet):
    """The light's half and the material's, for Principled materials.

    Parameters
    ----------
    pyramid : Pyramid
    families : Families

    Raises
    ------
    ShapeError
        A family has other lobes than ours, or is not sampled as they are.
    """

    def __init__(self, pyramid: Pyramid, families: Families) -> None:
        half = half_holds(pyramid.all_maps)
        atlas, places = atlas_texels(pyramid)
        self.textures = (
            GpuTexture("kernel bank", atlas, "RGBA16F" if half else "RGBA32F"),
            GpuTexture("kernel bank's places", places),
            GpuTexture("family of GGX", family_texels(families.ggx, GGX_LOBES)),
            GpuTexture("family of leaning facets", family_texels(families.leaning, LEANING_LOBES)),
            GpuTexture("albedos of GGX", albedo_texels(families)),
            GpuTexture("Fresnel terms", rise_table()[None, :, 1:]),
        )
        self._families = families
        # The widest maps, which come first, are of kernels that hardly cancel each other
        sizes = [len(sheet) for sheets in pyramid.all_maps for sheet in sheets]
        rows = sizes.count(sizes[0]) * (sizes[0] + 2)
        self._exact_from = rows if rows < len(atlas) else 0
        self._materials = MaterialBinding()

    def inputs(self, look: PrincipledLook | Surface) -> Inputs:
        """See `ProgramMapSet`; a `Surface` is shaded at points. Reference: core/kinds/kernel_pyramid."""
        is_antialiased = isinstance(look, PrincipledLook) and look.antialiased
        surface = look.surface if isinstance(look, PrincipledLook) else look
        textures = dict(zip(SAMPLERS, self.textures, strict=True))
        return Inputs(
            principled_shader,
            look_fields(surface, is_antialiased),
            textures,
            exact_from={"atlas": self._exact_from},
        )

    def split_sum(self) -> dict[str, GpuTexture]:
        """See `WithSplitSum`."""
        texels = family_texels(split_families(self._families).ggx, GGX_LOBES)
        return {"ggx": GpuTexture("split sum as a family", texels)}

    def draw(self, mesh: GpuMesh, draw: Draw, look: PrincipledLook | Surface | OwnMaterials) -> None:
        """See `GpuMapSet.draw`."""
        if isinstance(look, OwnMaterials):
            self._draw_slots(mesh, draw, look)
        else:
            super().draw(mesh, draw, look)

    def _draw_slots(self, mesh: GpuMesh, draw: Draw, look: OwnMaterials) -> None:
        """Draw each slot's triangles with its own material.

        What covers in part is drawn after all that covers, over what is there, and hides what is drawn later.
        Where nothing is covered, nothing is hidden.

        Raises
        ------
        ShapeError
            The mesh has no slots, or a material too many textures.
        """
        if not isinstance(mesh, GpuTexturedMesh):
            raise ShapeError(
                "A mesh without material slots has no materials of its own: choose one material."
            )
        opaque = [slot for slot, material in enumerate(look.slots) if material.is_opaque]
        others = [slot for slot, material in enumerate(look.slots) if not material.is_opaque]
        blending = gpu.state.blend_get()
        try:
            if opaque:
                gpu.state.blend_set("NONE")
                shader = opaque_shader()
                shader.bind()
                self._draw_with(shader, opaque, mesh, draw, look)
            if others:
                gpu.state.blend_set("ALPHA_PREMULT")
                shader = translucent_shader()
                for whole in (1.0, 0.0):
                    shader.bind()
                    shader.uniform_float("whole", whole)
                    self._draw_with(shader, others, mesh, draw, look)
        finally:
            gpu.state.blend_set(blending)

    def _draw_with(
        self,
        shader: gpu.types.GPUShader,
        slots: list[int],
        mesh: GpuTexturedMesh,
        draw: Draw,
        look: OwnMaterials,
    ) -> None:
        self._light(shader)
        for slot in slots:
            with self._materials.bound(shader, look.slots[slot], mesh.uv_maps, look.antialiased):
                mesh.draw_slot(shader, draw, slot, last=slot == len(look.slots) - 1)

    def _light(self, shader: gpu.types.GPUShader) -> None:
        for name, texture in zip(SAMPLERS, self.textures, strict=True):
            shader.uniform_sampler(name, texture.whole())


def look_fields(look: Surface, antialiased: bool) -> tuple[Array, ...]:
    """One material as the block of gpu_shaders/principled_frag.glsl."""
    return (
        np.append(look.base_color, look.metallic),
        np.append(look.specular_tint, look.specular_level),
        np.append(look.coat_tint, look.coat_weight),
        np.append(look.emission, look.alpha),
        np.array([look.roughness, look.ior, look.diffuse_roughness]),
        np.array([look.coat_roughness, look.coat_ior, antialiased]),
    )


def family_texels(family: Family, lobes: int) -> Array:
    """A family as gpu_shaders/lib/principled_radiance_lib.glsl reads it.

    Parameters
    ----------
    family : Family
    lobes : int
        How many it has, up to 4.

    Returns
    -------
    ndarray, shape (1 + K * C, S, A, 4), float32
        The tilts of the lobes; for each kernel and function, their weights: of GGX, `GLASS` in the place of
        the first rising power.

    Raises
    ------
    ShapeError
        It has other lobes, or is not sampled as the shader takes it to be.
    """
    count, rows = len(family.alpha), len(family.mu)
    widths = 2.0 ** ((np.arange(count) - count + 1) / _WIDTHS_AN_OCTAVE)
    regular = np.allclose(family.alpha, widths) and np.allclose(family.mu, (np.arange(rows) + 0.5) / rows)
    functions = family.weights.shape[4]
    if family.tilts.shape[2] != lobes or not regular or family.bank != KERNELS:
        raise ShapeError(
            f"Graphics cards take families of {len(KERNELS)} kernels and {lobes} lobes, at "
            f"{_WIDTHS_AN_OCTAVE} widths an octave and regular elevations: fit it anew."
        )
    texels = np.zeros((1 + len(KERNELS) * functions, rows, count, 4), dtype=np.float32)
    texels[0, ..., :lobes] = family.tilts.swapaxes(0, 1)
    weights = family.weights.transpose(3, 4, 1, 0, 2).astype(np.float64)
    if functions > 1:
        weights[:, 1] = np.einsum("kcrwl,c->krwl", weights[:, 1:], GLASS)
    texels[1:, ..., :lobes] = weights.reshape(-1, rows, count, lobes)
    return texels


def albedo_texels(families: Families) -> Array:
    """Albedos of GGX as gpu_shaders/lib/principled_lib.glsl reads them.

    Returns
    -------
    ndarray, shape (2, S, A, 4), float32
        The albedos of GGX times the powers from 2 onwards; that of GGX itself, its mean, 0 and 0.
    """
    albedo = families.ggx.albedo.swapaxes(0, 1)
    texels = np.zeros((2, *albedo.shape[:2], 4), dtype=np.float32)
    texels[0] = albedo[..., 1:]
    texels[1, ..., 0] = albedo[..., 0]
    texels[1, ..., 1] = families.mean(families.ggx.alpha)
    return texels
