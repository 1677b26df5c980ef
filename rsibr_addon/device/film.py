"""Pictures as means of samples: each is drawn to a stage, laid over what lies behind it, and added."""

from collections.abc import Iterator
from contextlib import contextmanager

import gpu
import numpy as np

from ..core.conventions import Array
from .passes import blended, screen_interface, screen_triangle
from .shaders import build, kept_until_exit


class Film:
    """The sum of a picture's samples, in linear radiance.

    Parameters
    ----------
    width, height : int
        In pixels.
    """

    def __init__(self, width: int, height: int) -> None:
        self._size = width, height
        self._sample, self._sum = (gpu.types.GPUTexture(self._size, format="RGBA32F") for _ in range(2))
        self._of_sample = gpu.types.GPUFrameBuffer(color_slots=(self._sample,))
        self._of_sum = gpu.types.GPUFrameBuffer(color_slots=(self._sum,))
        self._screen = screen_triangle(layer_shader())
        self._count = 0
        with self._of_sum.bind():
            self._of_sum.clear(color=(0.0, 0.0, 0.0, 0.0))

    @contextmanager
    def sample(self) -> Iterator[None]:
        """Within, a sample is drawn to the active frame buffer, which is empty; then it is added."""
        with self._of_sample.bind():
            self._of_sample.clear(color=(0.0, 0.0, 0.0, 0.0))
            yield
        with self._of_sum.bind(), blended("ADDITIVE_PREMULT"):
            self._draw(self._sample, 1.0)
        self._count += 1

    def lay(self, layer: gpu.types.GPUTexture, scale: float) -> None:
        """Lay a layer over the sample.

        Parameters
        ----------
        layer : GPUTexture
            Radiance times coverage, and coverage, of the pixels from the first on.
        scale : float
            Factor of radiance.
        """
        with blended("ALPHA_PREMULT"):
            self._draw(layer, scale)

    def read(self) -> Array:
        """The mean of the samples, shape (height, width, 4), float32, row 0 at the bottom."""
        width, height = self._size
        with self._of_sum.bind():
            read = self._of_sum.read_color(0, 0, width, height, 4, 0, "FLOAT")
        mean: Array = np.array(read, np.float32) / np.float32(max(self._count, 1))
        return mean

    def _draw(self, layer: gpu.types.GPUTexture, scale: float) -> None:
        shader = layer_shader()
        shader.bind()
        shader.uniform_float("scale", scale)
        shader.uniform_sampler("layer", layer)
        self._screen.draw(shader)


@kept_until_exit
def layer_shader() -> gpu.types.GPUShader:
    """Draws a layer of a picture."""
    info = screen_interface()
    info.push_constant("FLOAT", "scale")
    info.sampler(0, "FLOAT_2D", "layer")
    info.fragment_out(0, "VEC4", "colour")
    return build("layer", info, "screen_vert.glsl", "layer_frag.glsl")
