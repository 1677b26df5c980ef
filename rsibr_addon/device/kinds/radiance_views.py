"""Radiance views on the GPU: one upload of a map set, one draw of a mesh, in three modes.

The modes of [Cabral1999]: `paper` draws the destination sphere map of the frame on a tessellated
disk and shades from it; `texel` warps that map per texel; `fragment` needs no map in between.
"""

from functools import cached_property

import gpu
import numpy as np

from ...core.conventions import Array
from ...core.geometry.disk_mesh import disk_mesh
from ...core.geometry.geodesic import GeodesicSphere
from ...core.geometry.reflection_warp import Fading
from ...core.kinds.radiance_views.shading import Mode, ViewsLook
from ...core.kinds.radiance_views.views import RadianceViews
from ...core.kinds.radiance_views.warping import Warping, albedo_table, chosen_warping
from .. import buffers, shaders
from ..drawing import Draw, GpuMesh, Inputs, ProgramMapSet
from ..passes import screen_triangle
from ..textures import GpuTexture

_WARPINGS, _FADINGS = tuple(Warping), tuple(Fading)


class GpuRadianceViews(ProgramMapSet):
    """A map set's radiance views."""

    def __init__(self, views: RadianceViews) -> None:
        self._size, self._left_out = views.size, views.left_out
        self._views = GpuTexture("stack of radiance views", _layers(views))
        self._albedo = GpuTexture("table of albedo", _albedo_texels(views))
        self._geodesic = GpuTexture("geodesic sphere", _geodesic_texels(views.sphere))
        self.textures = (self._views, self._albedo, self._geodesic)
        self._last_level = len(views.sphere.levels) - 1

    @cached_property
    def _destination(self) -> "_Destination":
        return _Destination(self._size)

    def inputs(self, look: ViewsLook) -> Inputs:
        """See `ProgramMapSet.inputs`; of `fragment` mode. Reference: core/kinds/radiance_views/shading.py."""
        textures = {"albedo": self._albedo, "views": self._views, "sphere": self._geodesic}
        warping = chosen_warping(look.warping, self._left_out)
        choices = _WARPINGS.index(warping), _FADINGS.index(look.fading)
        numbers = np.array([*choices, self._last_level, look.antialiased], dtype=float)
        return Inputs(shaders.views_fragment_shader, (numbers,), textures)

    def draw(self, mesh: GpuMesh, draw: Draw, look: ViewsLook) -> None:
        """See `GpuMapSet.draw`. Reference: core/kinds/radiance_views/shading.py."""
        if look.mode is Mode.FRAGMENT:
            super().draw(mesh, draw, look)
            return
        mode = self._block.with_rows(self._inputs(look).rows)
        self._make_destination(mesh, draw, mode, look.mode)
        shader = shaders.views_destination_shader(mesh.is_deferred)
        shader.bind()
        shader.uniform_sampler("by_normal", self._destination.targets[0])
        shader.uniform_sampler("by_mirror", self._destination.targets[1])
        shader.uniform_block("mode", mode)
        shader.uniform_sampler("albedo", self._albedo.whole())
        mesh.draw(shader, draw)

    def _make_destination(
        self, mesh: GpuMesh, draw: Draw, block: gpu.types.GPUUniformBuf, mode: Mode
    ) -> None:
        """Draw the maps for the view of a mesh; block: of the look."""
        if mode is Mode.PAPER:
            shader, surface = shaders.views_disk_shader(), self._destination.disk
        else:
            shader, surface = shaders.views_texel_shader(), self._destination.screen
        depth_test = gpu.state.depth_test_get()
        with self._destination.framebuffer.bind():
            gpu.state.depth_test_set("NONE")
            shader.bind()
            mesh.place(shader, draw)
            shader.uniform_block("mode", block)
            shader.uniform_sampler("views", self._views.whole())
            shader.uniform_sampler("albedo", self._albedo.whole())
            shader.uniform_sampler("sphere", self._geodesic.whole())
            surface.draw(shader)
        gpu.state.depth_test_set(depth_test)


class _Destination:
    """The destination maps of a frame, and what they are drawn with."""

    def __init__(self, size: int) -> None:
        self.targets = (buffers.render_target(size), buffers.render_target(size))
        self.framebuffer = gpu.types.GPUFrameBuffer(color_slots=self.targets)
        self.disk = buffers.triangles(
            shaders.views_disk_shader(), {"position": disk_mesh().positions}, disk_mesh().triangles
        )
        self.screen = screen_triangle(shaders.views_texel_shader())


def _layers(views: RadianceViews) -> Array:
    """Layer 2 i is the diffuse map of view i, layer 2 i + 1 its glossy map; alpha is 1."""
    layers = np.ones((2 * len(views.diffuse), views.size, views.size, 4), dtype=np.float32)
    layers[0::2, ..., :3] = views.diffuse
    layers[1::2, ..., :3] = views.glossy
    return layers


def _albedo_texels(views: RadianceViews) -> Array:
    """The table that radiance is divided and multiplied by; alpha is 1."""
    texels = np.ones((*views.albedo.shape[:2], 4), dtype=np.float32)
    texels[..., :3] = albedo_table(views.albedo, Warping.ALBEDO)
    return texels


def _geodesic_texels(sphere: GeodesicSphere) -> Array:
    """The sphere as gpu_shaders/lib/geodesic_lib.glsl reads it."""
    rows = [sphere.vertices, sphere.centres, *sphere.levels]
    texels = np.zeros((len(rows), max(map(len, rows)), 4), dtype=np.float32)
    for texel_row, row in zip(texels, rows, strict=True):
        texel_row[: len(row), :3] = row
    return texels
