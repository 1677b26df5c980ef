"""An exactly lit sphere on the GPU, to shade any mesh as the sphere: the reference of pictures."""

import numpy as np

from ..core.geometry.lit_sphere import LitSphere
from . import buffers
from .drawing import Draw, GpuMesh
from .shaders import MeshProgram
from .textures import GpuTexture


class GpuLitSphere:
    """Radiance by normals; meshes must be seen from the sphere's view."""

    def __init__(self, sphere: LitSphere) -> None:
        rings, width = sphere.radiance.shape[:2]
        texels = np.ones((rings, width + 2, 4), dtype=np.float32)
        texels[..., :3] = sphere.radiance[:, np.arange(-1, width + 1) % width]
        self.textures = (GpuTexture("lit sphere", texels),)
        frame = np.eye(4)
        frame[:3, :3] = sphere.frame
        self._frame, self._block = frame, buffers.KeptBlock()

    def draw(self, mesh: GpuMesh, draw: Draw, look: None) -> None:
        """See `GpuMapSet.draw`; there is one look. Reference: `core.geometry.lit_sphere.LitSphere.at`."""
        shader = lit_sphere_shader()
        shader.bind()
        shader.uniform_block("sphere", self._block.filled(self._frame))
        shader.uniform_sampler("rings", self.textures[0].whole())
        mesh.draw(shader, draw)


lit_sphere_shader = MeshProgram("lit_sphere", "Sphere sphere", "mat4 frame;", {"rings": "FLOAT_2D"})
"""Draws a mesh from a lit sphere."""
