"""A pyramid of kernels and the families of lobes on the GPU: draws meshes in Principled materials."""

from collections.abc import Sequence
from dataclasses import replace

import gpu
import numpy as np

from ...core.brdf.fresnel_powers import rise_table
from ...core.brdf.principled import Surface
from ...core.conventions import Array
from ...core.errors import ShapeError
from ...core.half_floats import half_holds
from ...core.kinds.kernel_pyramid.atlas import atlas_texels
from ...core.kinds.kernel_pyramid.look import PrincipledLook
from ...core.kinds.kernel_pyramid.pyramid import Pyramid
from ...core.kinds.kernel_pyramid.shading import Families
from ...core.kinds.kernel_pyramid.split_sum import split_families
from ...core.suns import NO_SUNS
from ..drawing import Draw, GpuMesh, Inputs, ProgramMapSet
from ..own_materials import OwnMaterials
from ..shaders import MeshProgram, build, kept_until_exit, mesh_interface
from ..textured_materials import MaterialBinding, textured_program
from ..textured_mesh import GpuTexturedMesh
from ..textures import GpuTexture
from .kernel_pyramid_texels import albedo_texels, family_texels, lookup_texels, sheen_texels

SAMPLERS = {
    "atlas": "FLOAT_2D",
    "lookups": "FLOAT_2D",
    "ggx": "FLOAT_2D_ARRAY",
    "leaning": "FLOAT_2D_ARRAY",
    "albedos": "FLOAT_2D_ARRAY",
    "rises": "FLOAT_2D",
    "sheens": "FLOAT_2D",
}
"""Name of each of a pyramid's textures, in their order -> its type."""

SUNS = "SUNS"
"""Defined by programs for light with suns."""

principled_shader, sunlit_shader = (
    MeshProgram(
        "principled",
        "PrincipledLook look",
        "vec4 base; vec4 specular; vec4 coat; vec4 sheen; vec4 emission; vec4 boundary; vec4 coating;",
        SAMPLERS,
        defines,
    )
    for defines in ((), (SUNS,))
)
"""Draw a mesh of one Principled material, the same all over; the second one in light with suns."""


@kept_until_exit
def material_shader(defines: tuple[str, ...]) -> gpu.types.GPUShader:
    """Draws triangles of a material whose inputs are textures; defines: see `DrawnMaterial`, or `SUNS`."""
    return textured_program("principled_textured", SAMPLERS, defines)


@kept_until_exit
def depth_first_shader() -> gpu.types.GPUShader:
    """Draws the depth of a mesh, by which what it hides of itself is not shaded afterwards."""
    return build("depth_first", mesh_interface(""), "depth_first_vert.glsl", "viewport_occluder_frag.glsl")


class GpuPrincipled(ProgramMapSet):
    """Draws Principled materials from the light's half and the material's.

    Parameters
    ----------
    textures : sequence of GpuTexture
        In the order of `SAMPLERS`.
    has_suns : bool
        Whether the light has any.
    """

    def __init__(self, textures: Sequence[GpuTexture], has_suns: bool) -> None:
        self.textures = textures
        self._suns = (SUNS,) if has_suns else ()
        self._materials = MaterialBinding()

    def inputs(self, look: PrincipledLook | Surface) -> Inputs:
        """See `ProgramMapSet`; a `Surface` is shaded at points. Reference: core/kinds/kernel_pyramid."""
        is_antialiased = isinstance(look, PrincipledLook) and look.antialiased
        surface = look.surface if isinstance(look, PrincipledLook) else look
        textures = dict(zip(SAMPLERS, self.textures, strict=True))
        return Inputs(
            sunlit_shader if self._suns else principled_shader,
            look_fields(surface, is_antialiased),
            textures,
            exact_from={"atlas": 0},
        )

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
                shader = depth_first_shader()
                shader.bind()
                for slot in opaque:
                    mesh.draw_slot(shader, draw, slot, last=slot == len(look.slots) - 1)
                self._shade(opaque, mesh, draw, look)
            if others:
                gpu.state.blend_set("ALPHA_PREMULT")
                for whole in (1.0, 0.0):
                    self._shade(others, mesh, draw, look, whole)
        finally:
            gpu.state.blend_set(blending)

    def _shade(
        self,
        slots: list[int],
        mesh: GpuTexturedMesh,
        draw: Draw,
        look: OwnMaterials,
        whole: float | None = None,
    ) -> None:
        """Draw slots, each with its program; whole: the constant of those that have it."""
        bound: tuple[str, ...] | None = None
        for slot in slots:
            material = look.slots[slot]
            shader = material_shader((*material.defines, *self._suns))
            if material.defines != bound:
                bound = material.defines
                shader.bind()
                self._light(shader)
                if whole is not None:
                    shader.uniform_float("whole", whole)
            with self._materials.bound(shader, material, mesh.uv_maps, look.antialiased):
                mesh.draw_slot(shader, draw, slot, last=slot == len(look.slots) - 1)

    def _light(self, shader: gpu.types.GPUShader) -> None:
        for name, texture in zip(SAMPLERS, self.textures, strict=True):
            shader.uniform_sampler(name, texture.whole())


class GpuPyramid(GpuPrincipled):
    """A pyramid, and the families of lobes.

    Parameters
    ----------
    pyramid : Pyramid
    families : Families

    Raises
    ------
    ShapeError
        A family has more lobes than ours, or is not sampled as they are.
    """

    def __init__(self, pyramid: Pyramid, families: Families) -> None:
        half = half_holds(pyramid.all_maps)
        self._atlas_format = "RGBA16F" if half else "RGBA32F"
        atlas, places = atlas_texels(pyramid)
        families = replace(families, ggx=pyramid.resolved(families.ggx))
        lookups = lookup_texels(families, places, pyramid.suns, len(pyramid.bank))
        light = GpuTexture("kernel bank", atlas, self._atlas_format), GpuTexture("lookups", lookups)
        super().__init__((*light, *family_textures(families)), len(pyramid.suns) > 0)
        self._families, self._pyramid, self._places = families, pyramid, places

    def split_sum(self) -> dict[str, GpuTexture]:
        """See `WithSplitSum`."""
        split, resolved = split_families(self._families), len(self._pyramid.bank)
        split = replace(split, ggx=self._pyramid.resolved(split.ggx))
        textures = {
            "ggx": GpuTexture("split sum as a family", family_texels(split.ggx)),
            "lookups": GpuTexture(
                "split sum's lookups", lookup_texels(split, self._places, NO_SUNS, resolved)
            ),
        }
        if self._suns:
            atlas, _ = atlas_texels(replace(self._pyramid, suns=NO_SUNS))
            textures["atlas"] = GpuTexture("split sum's kernel bank", atlas, self._atlas_format)
        return textures


def family_textures(families: Families) -> tuple[GpuTexture, ...]:
    """The material's half: `SAMPLERS` from `ggx` on.

    Raises
    ------
    ShapeError
        See `GpuPyramid`.
    """
    return (
        GpuTexture("family of GGX", family_texels(families.ggx)),
        GpuTexture("family of leaning facets", family_texels(families.leaning)),
        GpuTexture("albedos of GGX", albedo_texels(families)),
        GpuTexture("Fresnel terms", rise_table()[None, :, 1:]),
        GpuTexture("sheen", sheen_texels(families)),
    )


def look_fields(look: Surface, antialiased: bool) -> tuple[Array, ...]:
    """One material as the block of gpu_shaders/principled_frag.glsl."""
    return (
        np.append(look.base_color, look.metallic),
        np.append(look.specular_tint, look.specular_level),
        np.append(look.coat_tint, look.coat_weight),
        np.append(look.sheen_tint, look.sheen_weight),
        np.append(look.emission, look.alpha),
        np.array([look.roughness, look.ior, look.diffuse_roughness, look.sheen_roughness]),
        np.array([look.coat_roughness, look.coat_ior, antialiased]),
    )
