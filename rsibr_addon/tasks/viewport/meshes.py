"""The meshes that viewports show, each uploaded once."""

from typing import Any

from ...device.drawing import GpuMesh
from ...host.meshes import content_of, evaluated_mesh, triangle_mesh
from ...host.visible_surfaces import Surface


class UploadedMeshes:
    """Meshes on the GPU, for as long as surfaces have them.

    Blender evaluates an object's mesh anew whenever any property of the object is set, ours too. So meshes
    are told apart by what they hold: one that is evaluated to the same again stays where it is.
    """

    def __init__(self) -> None:
        self._contents: dict[int, bytes] = {}
        self._uploaded: dict[bytes, GpuMesh] = {}

    def __len__(self) -> int:
        return len(self._uploaded)

    def of(self, surface: Surface, evaluated: Any, depsgraph: Any) -> GpuMesh | None:
        """What a surface is drawn with, uploaded from now on; None if it has no faces.

        Parameters
        ----------
        surface : Surface
        evaluated : bpy.types.Object
            As `host.visible_surfaces.surfaces` yields it with the surface.
        depsgraph : bpy.types.Depsgraph
        """
        if surface.mesh not in self._contents:
            with evaluated_mesh(evaluated, depsgraph) as mesh:
                content = content_of(mesh)
                if content not in self._uploaded and mesh.polygons:
                    triangles = triangle_mesh(mesh, evaluated.name)
                    self._uploaded[content] = GpuMesh(
                        triangles.positions, triangles.normals, triangles.triangles
                    )
                self._contents[surface.mesh] = content  # at last: what fails above is tried again
        uploaded = self._uploaded.get(self._contents[surface.mesh])
        return None if uploaded is None else uploaded.again()

    def keep(self, surfaces: list[Surface]) -> None:
        """Let go of what none of these surfaces has."""
        wanted = {surface.mesh for surface in surfaces}
        self._contents = {mesh: content for mesh, content in self._contents.items() if mesh in wanted}
        contents = set(self._contents.values())
        self._uploaded = {content: mesh for content, mesh in self._uploaded.items() if content in contents}
