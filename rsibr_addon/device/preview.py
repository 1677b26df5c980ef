"""Pictures of a mesh drawn off-screen, in linear radiance."""

from dataclasses import replace
from typing import Any

import gpu
import numpy as np

from ..core.conventions import Array, Indices
from ..core.geometry.camera import Camera
from . import buffers
from .context import ensure_context
from .deferred import DeferredMesh
from .drawing import Draw, GpuMapSet, GpuMesh, Refractive, WithInputs
from .passes import plain_state, screen_interface, screen_triangle
from .shaders import build, kept_until_exit

STILL = np.eye(3)
"""A turn that is none."""

SAMPLES_PER_AXIS = 4
"""Samples along each axis of a pixel, whose mean is the pixel: antialiased, as by Cycles' box filter."""

FOR_REFRACTION = 2
"""Factor of `SAMPLES_PER_AXIS` for refracted light: what is refracted at creases and outlines turns within a
sample."""

TILES = 2
"""Tiles along each axis that a picture is drawn in, in turn: a `DeferredMesh` takes 80 bytes a sample."""

BLOCK = 16
"""Samples that Mesa's software driver shades at once, those of a block of 4 x 4."""


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
        refracts = isinstance(self._content, Refractive) and self._content.refracts(look)
        tile, per_axis = -(-size // TILES), SAMPLES_PER_AXIS * (FOR_REFRACTION if refracts else 1)
        fine = tile * per_axis
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
        surface = positions, normals, _nearest_first(positions @ object_turn.T, triangles, camera)
        is_fine = len(triangles) * BLOCK > (TILES * fine) ** 2
        is_deferred = is_fine and isinstance(self._content, WithInputs)
        mesh = DeferredMesh(*surface, depth) if is_deferred else GpuMesh(*surface)
        picture = np.empty((TILES * tile, TILES * tile, 4), np.float32)
        for bottom, left in np.ndindex(TILES, TILES):
            place = tile * left, tile * bottom
            within = replace(placed, projection=_magnified(place, tile, size) @ placed.projection)
            self._draw_samples(target, mesh, within, look)
            rows, columns = (slice(start, start + tile) for start in place[::-1])
            picture[rows, columns] = _means(colour, tile, per_axis)
        return picture[:size, :size]

    def _draw_samples(self, target: gpu.types.GPUFrameBuffer, mesh: GpuMesh, placed: Draw, look: Any) -> None:
        depth_test, depth_mask = gpu.state.depth_test_get(), gpu.state.depth_mask_get()
        with target.bind():
            target.clear(color=(0.0, 0.0, 0.0, 0.0), depth=1.0)
            gpu.state.depth_test_set("LESS_EQUAL")
            gpu.state.depth_mask_set(True)
            try:
                if isinstance(mesh, DeferredMesh):
                    mesh.store(placed)
                self._content.draw(mesh, placed, look)
            finally:
                gpu.state.depth_test_set(depth_test)
                gpu.state.depth_mask_set(depth_mask)


def _means(samples: gpu.types.GPUTexture, size: int, per_axis: int) -> Array:
    """The means of each pixel's samples, of which there are many more to read back."""
    means = buffers.render_target(size)
    target = gpu.types.GPUFrameBuffer(color_slots=(means,))
    shader = sample_means_shader()
    with target.bind(), plain_state():
        shader.bind()
        shader.uniform_int("per_axis", per_axis)
        shader.uniform_sampler("samples", samples)
        screen_triangle(shader).draw(shader)
        return buffers.pixels(target, size)


def _magnified(place: tuple[int, int], tile: int, size: int) -> Array:
    """What makes a square of a picture fill the frame, shape (4, 4), for clip coordinates.

    Parameters
    ----------
    place : (int, int)
        The square's left and bottom, in pixels.
    tile, size : int
        Widths of the square and the picture, in pixels.
    """
    matrix = np.diag([size / tile, size / tile, 1.0, 1.0])
    matrix[:2, 3] = [(size - 2.0 * start) / tile - 1.0 for start in place]
    return matrix


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
