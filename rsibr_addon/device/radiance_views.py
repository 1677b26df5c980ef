"""Radiance views on the GPU: one upload of a map set, one draw of a mesh, in three modes.

The modes of [Cabral1999]: `paper` draws the destination sphere map of the frame on a tessellated
disk and shades from it; `texel` warps that map per texel; `fragment` needs no map in between.
"""

from dataclasses import dataclass
from enum import StrEnum

import gpu
import numpy as np

from ..core.conventions import Array, ArrayLike
from ..core.directions import camera_frame
from ..core.disk_mesh import disk_mesh
from ..core.geodesic import GeodesicSphere, barycentric_weights, find_triangle
from ..core.radiance_views import RadianceViews
from . import buffers, shaders


class Mode(StrEnum):
    """How radiance views are brought to the view of the frame."""

    PAPER = "paper"
    TEXEL = "texel"
    FRAGMENT = "fragment"


_SCREEN_TRIANGLE = np.array([[-1.0, -1.0], [3.0, -1.0], [-1.0, 3.0]])


@dataclass(frozen=True)
class Draw:
    """Where a mesh stands and from where it is seen; matrices of shape (4, 4) for column vectors.

    Attributes
    ----------
    model, view, projection : ndarray, shape (4, 4)
    eye : ndarray, shape (4,)
        Homogeneous position of the eye in world space, as `core.camera.Camera.eye`.
    view_dir : ndarray, shape (3,)
        Unit vector from the object to the eye: the view that destination maps are made for.
    """

    model: Array
    view: Array
    projection: Array
    eye: Array
    view_dir: Array

    def uniforms(self) -> gpu.types.GPUUniformBuf:
        """The block `Draw` of the shaders."""
        normal_matrix = np.eye(4)
        normal_matrix[:3, :3] = np.linalg.inv(self.model[:3, :3]).T
        return buffers.uniform_block(self.model, normal_matrix, self.view, self.projection, self.eye)


class RadianceViewsOnDevice:
    """A map set's radiance views, uploaded.

    Parameters
    ----------
    views : RadianceViews

    Raises
    ------
    DeviceError
        The driver refuses a shader.
    """

    def __init__(self, views: RadianceViews) -> None:
        self._sphere = views.sphere
        self._size = views.size
        self._views = buffers.texture_array(_layers(views))
        self._geodesic = buffers.texture(_geodesic_texels(views.sphere))
        self._targets = (buffers.render_target(views.size), buffers.render_target(views.size))
        self._destination = gpu.types.GPUFrameBuffer(color_slots=self._targets)
        self._disk = buffers.triangles(
            shaders.views_disk_shader(), {"position": disk_mesh().positions}, disk_mesh().triangles
        )
        self._screen = buffers.triangles(
            shaders.views_texel_shader(), {"position": _SCREEN_TRIANGLE}, np.array([[0, 1, 2]])
        )

    def draw(self, mesh: gpu.types.GPUBatch, draw: Draw, mode: Mode, split: bool) -> None:
        """Draw a mesh into the active frame buffer, with the depth test as it is set.

        Parameters
        ----------
        mesh : GPUBatch
            With attributes `position` and `normal`: see `mesh_batch`.
        draw : Draw
        mode : Mode
        split : bool
            Warp diffuse radiance by the normal and glossy by the mirror direction; else the whole
            by the mirror direction.

        Notes
        -----
        Reference: core/shading.py.
        """
        if mode is Mode.FRAGMENT:
            self._draw_fragment(mesh, draw, split)
        else:
            self._draw_destination(mesh, draw, mode, split)

    def _draw_fragment(self, mesh: gpu.types.GPUBatch, draw: Draw, split: bool) -> None:
        shader = shaders.views_fragment_shader()
        # Bound blocks must outlive the draw: Blender keeps no reference to them.
        placed, mode = draw.uniforms(), self._mode_uniforms(split)
        shader.bind()
        shader.uniform_block("draw", placed)
        shader.uniform_block("mode", mode)
        shader.uniform_sampler("views", self._views)
        shader.uniform_sampler("sphere", self._geodesic)
        mesh.draw(shader)

    def _draw_destination(self, mesh: gpu.types.GPUBatch, draw: Draw, mode: Mode, split: bool) -> None:
        blend = _blend_uniforms(self._sphere, draw.view_dir)
        self._make_destination(blend, mode, split)
        shader = shaders.views_destination_shader()
        placed = draw.uniforms()
        shader.bind()
        shader.uniform_block("draw", placed)
        shader.uniform_block("blend", blend)
        shader.uniform_sampler("by_normal", self._targets[0])
        shader.uniform_sampler("by_mirror", self._targets[1])
        mesh.draw(shader)

    def _make_destination(self, blend: gpu.types.GPUUniformBuf, mode: Mode, split: bool) -> None:
        if mode is Mode.PAPER:
            shader, surface = shaders.views_disk_shader(), self._disk
        else:
            shader, surface = shaders.views_texel_shader(), self._screen
        modes = self._mode_uniforms(split)
        depth_test = gpu.state.depth_test_get()
        with self._destination.bind():
            gpu.state.depth_test_set("NONE")
            shader.bind()
            shader.uniform_block("blend", blend)
            shader.uniform_block("mode", modes)
            shader.uniform_sampler("views", self._views)
            surface.draw(shader)
        gpu.state.depth_test_set(depth_test)

    def _mode_uniforms(self, split: bool) -> gpu.types.GPUUniformBuf:
        return buffers.uniform_block(np.array([float(split), float(len(self._sphere.levels) - 1)]))


def mesh_batch(positions: Array, normals: Array, triangles: Array) -> gpu.types.GPUBatch:
    """Upload a mesh for `RadianceViewsOnDevice.draw`.

    Parameters
    ----------
    positions, normals : ndarray, shape (V, 3)
    triangles : ndarray of int, shape (F, 3)

    Returns
    -------
    GPUBatch
    """
    attributes = {"position": positions, "normal": normals}
    return buffers.triangles(shaders.views_fragment_shader(), attributes, triangles)


def _layers(views: RadianceViews) -> Array:
    """Layer 2 i is the diffuse map of view i, layer 2 i + 1 its glossy map; alpha is 1."""
    layers = np.ones((2 * len(views.diffuse), views.size, views.size, 4), dtype=np.float32)
    layers[0::2, ..., :3] = views.diffuse
    layers[1::2, ..., :3] = views.glossy
    return layers


def _geodesic_texels(sphere: GeodesicSphere) -> Array:
    """The sphere as gpu_shaders/lib/geodesic_lib.glsl reads it: vertices, then triangles by level."""
    rows = [sphere.vertices, *sphere.levels]
    texels = np.zeros((len(rows), max(map(len, rows)), 4), dtype=np.float32)
    for texel_row, row in zip(texels, rows, strict=True):
        texel_row[: len(row), :3] = row
    return texels


def _blend_uniforms(sphere: GeodesicSphere, view_dir: ArrayLike) -> gpu.types.GPUUniformBuf:
    """The block `Blend`: the destination's axes, and the three sources around it."""
    frame = np.eye(4)
    frame[:3, :3] = camera_frame(view_dir)
    sources = find_triangle(sphere, view_dir)
    corners = sphere.vertices[sources]
    return buffers.uniform_block(frame, corners, barycentric_weights(view_dir, corners), sources)
