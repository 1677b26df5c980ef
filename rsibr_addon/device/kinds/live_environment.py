"""Light that changes with the scene, filtered on the GPU: [Kautz2004] section 5.

Six renders lie side by side in a strip. From it the GPU makes the mips, in the atlas that `mip_chain` shades
from, and harmonics; nothing is read back. A pass cannot read the texture that it writes, so each mip is
halved from the atlas into another strip, and copied from there into the atlas with its borders.
"""

from dataclasses import replace

import gpu
import numpy as np

from ...core.geometry.near_room import Room
from ...core.kinds.live_environment import FACE_COUNT, solid_angle_texels
from ...core.kinds.mip_chain.chain import check_size
from ...core.kinds.mip_chain.mip_lobes import MipLobes, texture_space_spread
from ...core.kinds.mip_chain.shading import MipLook
from ...core.kinds.mip_chain.texture_space import box_halved, tent_halved
from .. import buffers
from ..drawing import Draw, GpuMesh
from ..passes import plain_state, screen_triangle
from .live_environment_shaders import (
    bordered_shader,
    box_shader,
    face_shader,
    harmonics_shader,
    rows_shader,
    tent_shader,
)
from .mip_chain_shaders import look_fields, mip_chain_shader


class GpuLiveEnvironment:
    """Six faces, black at first, with their mips and harmonics.

    Parameters
    ----------
    size : int
        Width of a face in texels, a power of 2.
    across_borders : bool
        Whether mips are filtered across the faces' borders
        (`core.kinds.mip_chain.texture_space.tent_halved`), or within each face (`box_halved`), as the
        hardware of 2004 did.
    degree : int
        Degree of the harmonics of diffuse light: nine coefficients in the paper.

    Attributes
    ----------
    captured_at : tuple of float
        Where the faces are seen from, in world coordinates, which counts for looks with a room.

    Raises
    ------
    RangeError
        The size is no power of 2, or too large.
    DeviceError
        The driver refuses a shader.

    Notes
    -----
    Reference: `core.kinds.live_environment.chain_of_faces`.
    """

    def __init__(self, size: int, across_borders: bool = True, degree: int = 2) -> None:
        check_size(size, 1)
        self.size = size
        self.captured_at = (0.0, 0.0, 0.0)
        self._mip_count = size.bit_length()
        self.textures = ()
        self._halved = tent_shader() if across_borders else box_shader()
        self._solid_angles = buffers.texture(_as_texels(solid_angle_texels(size)))
        self._faces = _Map(FACE_COUNT * size, size)
        self._smaller = _Map(max(FACE_COUNT * size // 2, 1), max(size // 2, 1))
        self._atlas = _Map(FACE_COUNT * (size + 2), 2 * (size - 1 + self._mip_count) + 1)
        self._coefficients = (degree + 1) ** 2
        self._rows = _Map(self._coefficients, FACE_COUNT * size)
        self._harmonics = _Map(self._coefficients, 1)
        spread = texture_space_spread(size, tent_halved if across_borders else box_halved)
        self._lobes = MipLobes(self._mip_count, spread=spread)
        self._no_places = _Map(1, 1)
        self._shading = buffers.KeptBlock()
        self._screen = screen_triangle(face_shader())
        self.filter()

    def set_face(self, face: int, seen: gpu.types.GPUTexture) -> None:
        """Set a face from a render; `filter` has to be called before it shows.

        Parameters
        ----------
        face : int
            0 to 5, in the order of `core.maps.cube_map`.
        seen : GPUTexture
            Radiance, of a face's size; see `core.kinds.live_environment.face_view`.
        """
        shader = face_shader()
        with plain_state():
            shader.bind()
            shader.uniform_sampler("seen", seen)
            shader.uniform_int("face", face)
            self._fill(self._faces, shader, (face * self.size, 0, self.size, self.size))

    def filter(self) -> None:
        """Make the mips and the coefficients anew."""
        with plain_state():
            self._border(self._faces, 0)
            for mip in range(self._mip_count - 1):
                self._halve(mip)
                self._border(self._smaller, mip + 1)
            self._sum_harmonics()

    def finish(self) -> None:
        """Wait until the GPU has finished."""
        self._harmonics.framebuffer.read_color(0, 0, 1, 1, 4, 0, "FLOAT")

    def draw(self, mesh: GpuMesh, draw: Draw, look: MipLook) -> None:
        """See `GpuMapSet.draw`. Reference: core/kinds/mip_chain/shading.py."""
        look = look if look.room is Room.DISTANT else replace(look, captured_at=self.captured_at)
        shading = self._shading.filled(*look_fields(look, self._lobes))
        shader = mip_chain_shader()
        shader.bind()
        shader.uniform_block("look", shading)
        shader.uniform_sampler("atlas", self._atlas.texture)
        shader.uniform_sampler("harmonics", self._harmonics.texture)
        shader.uniform_sampler("places", self._no_places.texture)
        mesh.draw(shader, draw)

    def _border(self, strip: "_Map", mip: int) -> None:
        rows = (self.size >> mip) + 2
        shader = bordered_shader()
        shader.bind()
        shader.uniform_sampler("strip", strip.texture)
        self._say_where(shader, mip)
        bottom = 2 * (self.size - (self.size >> mip) + mip)
        self._fill(self._atlas, shader, (0, bottom, FACE_COUNT * rows, rows))

    def _halve(self, mip: int) -> None:
        half = self.size >> (mip + 1)
        self._halved.bind()
        self._halved.uniform_sampler("atlas", self._atlas.texture)
        if self._halved is tent_shader():
            self._halved.uniform_sampler("solid_angles", self._solid_angles)
        self._say_where(self._halved, mip)
        self._fill(self._smaller, self._halved, (0, 0, FACE_COUNT * half, half))

    def _sum_harmonics(self) -> None:
        shader = rows_shader()
        shader.bind()
        shader.uniform_sampler("strip", self._faces.texture)
        shader.uniform_sampler("solid_angles", self._solid_angles)
        self._fill(self._rows, shader, (0, 0, self._coefficients, FACE_COUNT * self.size))
        shader = harmonics_shader()
        shader.bind()
        shader.uniform_sampler("rows", self._rows.texture)
        self._fill(self._harmonics, shader, (0, 0, self._coefficients, 1))

    def _say_where(self, shader: gpu.types.GPUShader, mip: int) -> None:
        shader.uniform_int("first_size", self.size)
        shader.uniform_int("mip", mip)

    def _fill(self, target: "_Map", shader: gpu.types.GPUShader, place: tuple[int, int, int, int]) -> None:
        """Run a program over a rectangle (left, bottom, width, height) of a map."""
        with target.framebuffer.bind():
            target.framebuffer.viewport_set(*place)
            self._screen.draw(shader)


class _Map:
    """An empty map to be drawn to and looked up, RGBA32F."""

    def __init__(self, width: int, height: int) -> None:
        self.texture = gpu.types.GPUTexture((width, height), format="RGBA32F")
        self.texture.clear(format="FLOAT", value=(0.0, 0.0, 0.0, 1.0))
        self.texture.filter_mode(True)
        self.texture.extend_mode("EXTEND")
        self.framebuffer = gpu.types.GPUFrameBuffer(color_slots=(self.texture,))


def _as_texels(values: np.ndarray) -> np.ndarray:
    return np.repeat(values[..., None], 4, axis=-1)
