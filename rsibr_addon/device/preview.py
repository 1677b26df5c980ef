"""Pictures of a mesh drawn off-screen, in linear radiance."""

from typing import Any

import gpu
import numpy as np

from ..core.conventions import Array, Indices
from ..core.geometry.camera import Camera
from . import buffers
from .context import ensure_context
from .drawing import Draw, GpuMapSet, GpuMesh
from .passes import plain_state, screen_interface, screen_triangle
from .shaders import build, kept_until_exit

STILL = np.eye(3)
"""A turn that is none."""

SAMPLES_PER_AXIS = 4
"""Samples along each axis of a pixel, whose mean is the pixel: antialiased, as by Cycles' box filter."""


class PreviewRenderer:
    """Draws meshes, shaded from a map set, into pictures.

    Raises
    ------
    DeviceError
        There is no graphics driver.
    """

    def __init__(self, content: GpuMapSet) -> None:
        ensure_context()
        self._content = content

    def draw(
        self,
        positions: Array,
        normals: Array,
        triangles: Indices,
        camera: Camera,
        size: int,
        look: Any,
        object_turn: Array = STILL,
        light_turn: Array = STILL,
    ) -> Array:
        """Draw one picture.

        Parameters
        ----------
        positions, normals : ndarray, shape (V, 3)
            A mesh within the unit sphere, in world coordinates.
        triangles : ndarray of int, shape (F, 3)
        camera : Camera
        size : int
            Width and height of the picture in pixels.
        look : object
            Look of the content's kind: see `core.kinds`.
        object_turn, light_turn : ndarray, shape (3, 3)
            Rotations of the mesh and of the light, from where they were made.

        Returns
        -------
        ndarray, shape (size, size, 4), float32
            Radiance times coverage, and coverage; row 0 at the bottom.
        """
        fine = size * SAMPLES_PER_AXIS
        colour = buffers.render_target(fine)
        depth = gpu.types.GPUTexture((fine, fine), format="DEPTH_COMPONENT32F")
        target = gpu.types.GPUFrameBuffer(depth_slot=depth, color_slots=(colour,))
        model = np.eye(4)
        model[:3, :3] = object_turn
        placed = Draw(
            model=model,
            view=np.linalg.inv(camera.world_from_camera),
            projection=camera.projection,
            eye=camera.eye,
            turn=light_turn.T,
        )
        mesh = GpuMesh(positions, normals, _nearest_first(positions @ object_turn.T, triangles, camera))
        depth_test, depth_mask = gpu.state.depth_test_get(), gpu.state.depth_mask_get()
        with target.bind():
            target.clear(color=(0.0, 0.0, 0.0, 0.0), depth=1.0)
            gpu.state.depth_test_set("LESS_EQUAL")
            gpu.state.depth_mask_set(True)
            try:
                self._content.draw(mesh, placed, look)
            finally:
                gpu.state.depth_test_set(depth_test)
                gpu.state.depth_mask_set(depth_mask)
        return self._means(colour, size)

    def _means(self, samples: gpu.types.GPUTexture, size: int) -> Array:
        """The means of each pixel's samples, which are sixteen times as much to read back."""
        means = buffers.render_target(size)
        target = gpu.types.GPUFrameBuffer(color_slots=(means,))
        shader = sample_means_shader()
        with target.bind(), plain_state():
            shader.bind()
            shader.uniform_int("per_axis", SAMPLES_PER_AXIS)
            shader.uniform_sampler("samples", samples)
            screen_triangle(shader).draw(shader)
            return buffers.pixels(target, size)


def _nearest_first(positions: Array, triangles: Indices, camera: Camera) -> Indices:
    """Triangles from the eye onwards: what others hide is then not shaded, most of the far side of a mesh."""
    nearness = positions @ camera.world_from_camera[:3, 2]
    ordered: Indices = triangles[np.argsort(-nearness[triangles].sum(axis=1), kind="stable")]
    return ordered


@kept_until_exit
def sample_means_shader() -> gpu.types.GPUShader:
    """Makes pixels of samples."""
    info = screen_interface()
    info.push_constant("INT", "per_axis")
    info.sampler(0, "FLOAT_2D", "samples")
    info.fragment_out(0, "VEC4", "mean")
    return build("sample_means", info, "screen_vert.glsl", "sample_means_frag.glsl")
