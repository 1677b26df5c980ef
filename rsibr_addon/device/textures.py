"""Textures whose values are made in any thread, and come to the GPU later, piece by piece."""

import gpu
import numpy as np

from ..core.conventions import Array
from ..core.errors import DeviceError
from . import buffers
from .passes import plain_state, screen_interface, screen_triangle
from .shaders import build, kept_until_exit


class GpuTexture:
    """A map that is looked up bilinearly within its edges; nothing of it is on the GPU at first.

    Blender's `gpu` module fills a texture only where it makes it. So what is too large for one piece is drawn
    into its place, some rows at a time.

    Parameters
    ----------
    name : str
        For messages.
    values : ndarray, shape (height, width, 4) or (layers, height, width, 4)
    texel_format : str
        "RGBA32F", or "RGBA16F" for values within half floats' range.
    deep : bool
        Whether it is looked up between its layers as well.
    """

    def __init__(self, name: str, values: Array, texel_format: str = "RGBA32F", deep: bool = False) -> None:
        self._name, self._format, self._deep = name, texel_format, deep
        self._shape = values.shape
        if texel_format == "RGBA16F":  # Drivers round in several ways where they draw
            values = values.astype(np.float16)
        self._values: Array | None = np.ascontiguousarray(values, dtype=np.float32)
        self._texture: gpu.types.GPUTexture | None = None
        self._rows_there = 0

    @classmethod
    def drawn(cls, texture: gpu.types.GPUTexture) -> "GpuTexture":
        """One that the GPU draws, and so has."""
        made = cls.__new__(cls)
        made._values, made._texture = None, texture
        return made

    @property
    def is_whole(self) -> bool:
        """Whether all of it is on the GPU."""
        return self._values is None

    @property
    def values(self) -> Array:
        """What it was made of, shape ([layers,] height, width, 4), as long as it is not on the GPU."""
        assert self._values is not None
        return self._values

    def whole(self) -> gpu.types.GPUTexture:
        """The texture; what is missing is uploaded.

        Raises
        ------
        DeviceError
            It is larger than the device takes.
        """
        if self._values is not None:
            self.upload(self._values.nbytes)
        return self._texture

    def upload(self, most: int) -> int:
        """Upload the next piece.

        Parameters
        ----------
        most : int
            Bytes that it may have, above 0; it has at least a row.

        Returns
        -------
        int
            Bytes that it had; 0 where all is there.

        Raises
        ------
        DeviceError
            It is larger than the device takes.
        """
        if self._values is None:
            return 0
        rows = self._values.reshape(-1, *self._shape[-2:])
        if self._texture is None and rows.nbytes <= most:
            self._texture, self._values = self._made(buffers.buffer(rows)), None
            return rows.nbytes
        if self._texture is None:
            self._texture = self._made(None)
        width, tallest = self._shape[-2], gpu.capabilities.max_texture_size_get()
        begin = self._rows_there
        piece = rows[begin : begin + min(max(most // rows[0].nbytes, 1), tallest)]
        texels = gpu.types.GPUTexture((width, len(piece)), format="RGBA32F", data=buffers.buffer(piece))
        self._draw(texels, begin, begin + len(piece))
        self._rows_there += len(piece)
        if self._rows_there == len(rows):
            self._values = None
        return piece.nbytes

    def _made(self, data: gpu.types.Buffer | None) -> gpu.types.GPUTexture:
        height, width = self._shape[-3:-1]
        largest = gpu.capabilities.max_texture_size_get()
        if max(width, height) > largest:
            raise DeviceError(
                f"The {self._name} takes a texture {max(width, height)} wide, and this device has {largest} "
                f"at most: make a smaller one."
            )
        layers = self._shape[0] if len(self._shape) == 4 else 0
        size = (width, height, layers) if self._deep else (width, height)
        array = 0 if self._deep else layers
        given = {} if data is None else {"data": data}
        return buffers.smooth(gpu.types.GPUTexture(size, layers=array, format=self._format, **given))

    def _draw(self, piece: gpu.types.GPUTexture, begin: int, end: int) -> None:
        """Copy rows to their place among those of all layers."""
        height, width = self._shape[-3:-1]
        shader = texels_shader()
        triangle = screen_triangle(shader)
        with plain_state():
            shader.bind()
            shader.uniform_sampler("piece", piece)
            for layer in range(begin // height, (end - 1) // height + 1):
                bottom, top = max(begin - layer * height, 0), min(end - layer * height, height)
                place = {"texture": self._texture, "layer": layer} if len(self._shape) == 4 else self._texture
                target = gpu.types.GPUFrameBuffer(color_slots=(place,))
                with target.bind():
                    target.viewport_set(0, bottom, width, top - bottom)
                    shader.uniform_int("above", layer * height - begin)
                    triangle.draw(shader)


@kept_until_exit
def texels_shader() -> gpu.types.GPUShader:
    """Copies rows of texels."""
    info = screen_interface()
    info.push_constant("INT", "above")
    info.sampler(0, "FLOAT_2D", "piece")
    info.fragment_out(0, "VEC4", "texels")
    return build("texels", info, "screen_vert.glsl", "texels_frag.glsl")
