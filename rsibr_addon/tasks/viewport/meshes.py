"""The meshes that viewports show, each uploaded once."""

from typing import Any

from ...device.drawing import GpuMesh
from ...device.textured_mesh import GpuTexturedMesh
from ...host.baked_inputs import add_unwrapping
from ...host.meshes import content_of, evaluated_mesh, triangle_mesh
from ...host.textured_meshes import MeshNeeds, textured_content_of, textured_mesh
from ...host.visible_surfaces import Surface
from .own_materials import ShownMaterials

Wanted = tuple[int, MeshNeeds | None]
"""The number of a mesh, and what materials need of it; None where it is drawn without its own."""


class UploadedMeshes:
    """Meshes on the GPU, for as long as surfaces have them.

    Blender evaluates an object's mesh anew whenever any property of the object is set, ours too. So meshes
    are told apart by what they hold: one that is evaluated to the same again stays where it is.
    """

    def __init__(self) -> None:
        self._contents: dict[Wanted, bytes] = {}
        self._uploaded: dict[bytes, GpuMesh] = {}

    def __len__(self) -> int:
        return len(self._uploaded)

    def of(
        self, surface: Surface, evaluated: Any, depsgraph: Any, materials: ShownMaterials | None
    ) -> GpuMesh | None:
        """What a surface is drawn with, uploaded from now on; None if it has no faces.

        Parameters
        ----------
        surface : Surface
        evaluated : bpy.types.Object
            As `host.visible_surfaces.surfaces` yields it with the surface.
        depsgraph : bpy.types.Depsgraph
        materials : ShownMaterials or None
            Its own, if it is drawn with them.
        """
        needs = materials.needs if materials else None
        wanted = surface.mesh, needs
        if wanted not in self._contents:
            with evaluated_mesh(evaluated, depsgraph) as mesh:
                if materials and materials.unwrapping:
                    add_unwrapping(mesh, *materials.unwrapping)
                content = textured_content_of(mesh, needs) if needs else content_of(mesh)
                if content not in self._uploaded and mesh.polygons:
                    self._uploaded[content] = _uploaded(mesh, evaluated.name, needs)
                self._contents[wanted] = content  # at last: what fails above is tried again
        uploaded = self._uploaded.get(self._contents[wanted])
        return None if uploaded is None else uploaded.again()

    def keep(self, wanted: set[Wanted]) -> None:
        """Let go of all but these."""
        self._contents = {mesh: content for mesh, content in self._contents.items() if mesh in wanted}
        contents = set(self._contents.values())
        self._uploaded = {content: mesh for content, mesh in self._uploaded.items() if content in contents}


def _uploaded(mesh: Any, name: str, needs: MeshNeeds | None) -> GpuMesh:
    if needs is None:
        plain = triangle_mesh(mesh, name)
        return GpuMesh(plain.positions, plain.normals, plain.triangles)
    given = textured_mesh(mesh, name, needs)
    return GpuTexturedMesh(
        given.positions,
        given.normals,
        given.triangles,
        given.slots,
        given.uv,
        given.tangents,
        given.uv_maps,
    )
