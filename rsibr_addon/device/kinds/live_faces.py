"""Six renders of changing light side by side in a strip, from which all else is made on the GPU."""

import gpu

from ...core.kinds.live_environment import FACE_COUNT
from ..passes import plain_state, screen_triangle
from .live_environment_shaders import bordered_shader, face_shader


class Target:
    """An empty map to be drawn to and looked up, RGBA32F."""

    def __init__(self, width: int, height: int) -> None:
        self.texture = gpu.types.GPUTexture((width, height), format="RGBA32F")
        self.texture.clear(format="FLOAT", value=(0.0, 0.0, 0.0, 1.0))
        self.texture.filter_mode(True)
        self.texture.extend_mode("EXTEND")
        self.framebuffer = gpu.types.GPUFrameBuffer(color_slots=(self.texture,))


class LiveFaces:
    """Six faces, black at first.

    Parameters
    ----------
    size : int
        Width of a face in texels.

    Attributes
    ----------
    captured_at : tuple of float
        Where the faces are seen from, in world coordinates.
    """

    def __init__(self, size: int) -> None:
        self.size = size
        self.captured_at = (0.0, 0.0, 0.0)
        self._faces = Target(FACE_COUNT * size, size)
        self._screen = screen_triangle(face_shader())

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

    def _border(self, strip: Target, mip: int, atlas: Target) -> None:
        """Copy a mip from a strip to its place in an atlas, each face within its neighbours' texels."""
        rows = (self.size >> mip) + 2
        shader = bordered_shader()
        shader.bind()
        shader.uniform_sampler("strip", strip.texture)
        shader.uniform_int("first_size", self.size)
        shader.uniform_int("mip", mip)
        bottom = 2 * (self.size - (self.size >> mip) + mip)
        self._fill(atlas, shader, (0, bottom, FACE_COUNT * rows, rows))

    def _fill(self, target: Target, shader: gpu.types.GPUShader, place: tuple[int, int, int, int]) -> None:
        """Run a program over a rectangle (left, bottom, width, height) of a map."""
        with target.framebuffer.bind():
            target.framebuffer.viewport_set(*place)
            self._screen.draw(shader)
