"""The normals of surfaces, as pictures."""

import gpu

from .drawing import Draw, GpuMesh
from .own_materials import OwnMaterials
from .shaders import build, kept_until_exit, mesh_interface
from .textured_materials import NORMALS, MaterialBinding, textured_program
from .textured_mesh import GpuTexturedMesh


class Normals:
    """Draws normals; what it makes of materials is kept as long as they are."""

    def __init__(self) -> None:
        self._materials = MaterialBinding()

    def draw(self, mesh: GpuMesh, draw: Draw) -> None:
        """Draw a mesh's own."""
        shader = normal_shader()
        shader.bind()
        mesh.draw(shader, draw)

    def draw_shading(self, mesh: GpuTexturedMesh, draw: Draw, look: OwnMaterials) -> None:
        """Draw those that materials are shaded with: by normal maps and bumps."""
        shader = shading_normal_shader()
        shader.bind()
        for slot, material in enumerate(look.slots):
            with self._materials.bound(shader, material, mesh.uv_maps, look.antialiased):
                mesh.draw_slot(shader, draw, slot, last=slot == len(look.slots) - 1)


@kept_until_exit
def normal_shader() -> gpu.types.GPUShader:
    """Draws the normals of a mesh."""
    return build("normal", mesh_interface(""), "mesh_vert.glsl", "normal_frag.glsl")


@kept_until_exit
def shading_normal_shader() -> gpu.types.GPUShader:
    """Draws the normals that a material is shaded with."""
    return textured_program("principled_textured", {}, (NORMALS,))
