"""Light that changes with the scene, filtered on the GPU: [Kautz2004] section 5.

Six renders lie side by side in a strip. From it the GPU makes the mips, in the atlas that `mip_chain` shades
from, and harmonics; nothing is read back. A pass cannot read the texture that it writes, so each mip is
halved from the atlas into another strip, and copied from there into the atlas with its borders.
"""

from dataclasses import replace

import numpy as np

from ...core.geometry.near_room import Room
from ...core.kinds.live_environment import FACE_COUNT, solid_angle_texels
from ...core.kinds.mip_chain.chain import check_size
from ...core.kinds.mip_chain.mip_lobes import MipLobes, texture_space_spread
from ...core.kinds.mip_chain.shading import MipLook
from ...core.kinds.mip_chain.texture_space import box_halved, tent_halved
from .. import buffers
from ..drawing import Draw, GpuMesh
from ..passes import plain_state
from .live_environment_shaders import box_shader, harmonics_shader, rows_shader, tent_shader
from .live_faces import LiveFaces, Target
from .mip_chain_shaders import look_fields, mip_chain_shader


class GpuLiveEnvironment(LiveFaces):
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
        super().__init__(size)
        self._mip_count = size.bit_length()
        self.textures = ()
        self._halved = tent_shader() if across_borders else box_shader()
        self._solid_angles = buffers.texture(_as_texels(solid_angle_texels(size)))
        self._smaller = Target(max(FACE_COUNT * size // 2, 1), max(size // 2, 1))
        self._atlas = Target(FACE_COUNT * (size + 2), 2 * (size - 1 + self._mip_count) + 1)
        self._coefficients = (degree + 1) ** 2
        self._rows = Target(self._coefficients, FACE_COUNT * size)
        self._harmonics = Target(self._coefficients, 1)
        spread = texture_space_spread(size, tent_halved if across_borders else box_halved)
        self._lobes = MipLobes(self._mip_count, spread=spread)
        self._no_places = Target(1, 1)
        self._shading = buffers.KeptBlock()
        self.filter()

    def filter(self) -> None:
        """Make the mips and the coefficients anew."""
        with plain_state():
            self._border(self._faces, 0, self._atlas)
            for mip in range(self._mip_count - 1):
                self._halve(mip)
                self._border(self._smaller, mip + 1, self._atlas)
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

    def _halve(self, mip: int) -> None:
        half = self.size >> (mip + 1)
        self._halved.bind()
        self._halved.uniform_sampler("atlas", self._atlas.texture)
        if self._halved is tent_shader():
            self._halved.uniform_sampler("solid_angles", self._solid_angles)
        self._halved.uniform_int("first_size", self.size)
        self._halved.uniform_int("mip", mip)
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


def _as_texels(values: np.ndarray) -> np.ndarray:
    return np.repeat(values[..., None], 4, axis=-1)
