"""Radiance views on the GPU: one upload of a map set, one draw of a mesh, in three modes.

The modes of [Cabral1999]: `paper` draws the destination sphere map of the frame on a tessellated
disk and shades from it; `texel` warps that map per texel; `fragment` needs no map in between.
"""

import gpu
import numpy as np

from ...core.conventions import Array
from ...core.geometry.disk_mesh import disk_mesh
from ...core.geometry.geodesic import GeodesicSphere
from ...core.kinds.radiance_views.shading import LEAST_ALBEDO, Mode, ViewsLook, Warping
from ...core.kinds.radiance_views.views import RadianceViews
from .. import buffers, shaders
from ..drawing import Draw, GpuMesh

_SCREEN_TRIANGLE = np.array([[-1.0, -1.0], [3.0, -1.0], [-1.0, 3.0]])


class GpuRadianceViews:
    """A map set's radiance views, uploaded.

    Raises
    ------
    DeviceError
        The driver refuses a shader.
    """

    def __init__(self, views: RadianceViews) -> None:
        self._views = buffers.texture_array(_layers(views))
        self._albedo = buffers.texture(_albedo_texels(views))
        self._geodesic = buffers.texture(_geodesic_texels(views.sphere))
        last_level = len(views.sphere.levels) - 1
        self._modes = {
            (warping, antialiased): buffers.uniform_block(
                np.array([float(number), float(last_level), float(antialiased)])
            )
            for number, warping in enumerate(Warping)
            for antialiased in (False, True)
        }
        self._view_dir = buffers.KeptBlock()
        self._targets = (buffers.render_target(views.size), buffers.render_target(views.size))
        self._destination = gpu.types.GPUFrameBuffer(color_slots=self._targets)
        self._disk = buffers.triangles(
            shaders.views_disk_shader(), {"position": disk_mesh().positions}, disk_mesh().triangles
        )
        self._screen = buffers.triangles(
            shaders.views_texel_shader(), {"position": _SCREEN_TRIANGLE}, np.array([[0, 1, 2]])
        )

    def draw(self, mesh: GpuMesh, draw: Draw, look: ViewsLook) -> None:
        """See `GpuMapSet.draw`. Reference: core/kinds/radiance_views/shading.py."""
        if look.mode is Mode.FRAGMENT:
            shader = shaders.views_fragment_shader()
            shader.bind()
            shader.uniform_sampler("views", self._views)
            shader.uniform_sampler("sphere", self._geodesic)
        else:
            destination = self._view_dir.filled(draw.view_dir)
            self._make_destination(destination, look)
            shader = shaders.views_destination_shader()
            shader.bind()
            shader.uniform_block("destination", destination)
            shader.uniform_sampler("by_normal", self._targets[0])
            shader.uniform_sampler("by_mirror", self._targets[1])
        shader.uniform_block("mode", self._modes[look.warping, look.antialiased])
        shader.uniform_sampler("albedo", self._albedo)
        mesh.draw(shader, draw)

    def _make_destination(self, destination: gpu.types.GPUUniformBuf, look: ViewsLook) -> None:
        if look.mode is Mode.PAPER:
            shader, surface = shaders.views_disk_shader(), self._disk
        else:
            shader, surface = shaders.views_texel_shader(), self._screen
        depth_test = gpu.state.depth_test_get()
        with self._destination.bind():
            gpu.state.depth_test_set("NONE")
            shader.bind()
            shader.uniform_block("destination", destination)
            shader.uniform_block("mode", self._modes[look.warping, look.antialiased])
            shader.uniform_sampler("views", self._views)
            shader.uniform_sampler("albedo", self._albedo)
            shader.uniform_sampler("sphere", self._geodesic)
            surface.draw(shader)
        gpu.state.depth_test_set(depth_test)


def _layers(views: RadianceViews) -> Array:
    """Layer 2 i is the diffuse map of view i, layer 2 i + 1 its glossy map; alpha is 1."""
    layers = np.ones((2 * len(views.diffuse), views.size, views.size, 4), dtype=np.float32)
    layers[0::2, ..., :3] = views.diffuse
    layers[1::2, ..., :3] = views.glossy
    return layers


def _albedo_texels(views: RadianceViews) -> Array:
    """The table that radiance is divided and multiplied by; alpha is 1."""
    texels = np.ones((*views.albedo.shape[:2], 4), dtype=np.float32)
    texels[..., :3] = views.albedo + LEAST_ALBEDO
    return texels


def _geodesic_texels(sphere: GeodesicSphere) -> Array:
    """The sphere as gpu_shaders/lib/geodesic_lib.glsl reads it."""
    rows = [sphere.vertices, sphere.centres, *sphere.levels]
    texels = np.zeros((len(rows), max(map(len, rows)), 4), dtype=np.float32)
    for texel_row, row in zip(texels, rows, strict=True):
        texel_row[: len(row), :3] = row
    return texels
