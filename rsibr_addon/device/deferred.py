"""Deferred shading: what is seen of a mesh is stored first, and then shaded."""

import gpu

from ..core.conventions import Array, Indices
from .drawing import Draw, GpuMesh
from .passes import screen_triangle
from .shaders import G_BUFFER, g_buffer_shader


class DeferredMesh(GpuMesh):
    """A mesh of small triangles, each of whose samples is shaded once.

    Drivers shade blocks of samples: four at least, 16 in Mesa's software driver. A block that three triangles
    share is shaded three times. A G-buffer that is shaded afterwards knows no triangles.

    Parameters
    ----------
    positions, normals : ndarray, shape (V, 3)
    triangles : ndarray of int, shape (F, 3)
    depth : GPUTexture
        The depths of the frame buffer that the mesh is drawn into, which is square.
    """

    is_deferred = True

    def __init__(
        self, positions: Array, normals: Array, triangles: Indices, depth: gpu.types.GPUTexture
    ) -> None:
        super().__init__(positions, normals, triangles)
        size = depth.width, depth.height
        self._g_buffer = {name: gpu.types.GPUTexture(size, format="RGBA32F") for name in G_BUFFER}
        self._target = gpu.types.GPUFrameBuffer(depth_slot=depth, color_slots=tuple(self._g_buffer.values()))

    def store(self, draw: Draw) -> None:
        """Draw into the depths and the G-buffer, with the current depth test."""
        shader = g_buffer_shader()
        with self._target.bind():
            shader.bind()
            super().draw(shader, draw)

    def draw(self, shader: gpu.types.GPUShader, draw: Draw) -> None:
        """Shade what is stored, with a program that is deferred; it sets the depth test and mask."""
        self.place(shader, draw)
        for name, texture in self._g_buffer.items():
            shader.uniform_sampler(name, texture)
        # Behind all that was drawn, and so where anything was
        gpu.state.depth_test_set("GREATER")
        gpu.state.depth_mask_set(False)
        screen_triangle(shader).draw(shader)
