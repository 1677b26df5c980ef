"""What lies behind all surfaces: an environment, or a picture."""

from typing import Protocol

import gpu
import numpy as np
from mathutils import Matrix

from ..core.conventions import Array
from ..core.environment import Environment
from ..core.pictures.matte import PictureFrame
from .buffers import with_alpha
from .equirect import map_texture
from .passes import blended, screen_interface, screen_triangle
from .preview_stage import Sight
from .shaders import build, kept_until_exit
from .textures import GpuTexture


class Behind(Protocol):
    """What can lie behind all surfaces; nothing of it is on the GPU at first."""

    def draw(self, sight: Sight, turn: Array, strength: float, frame: PictureFrame, exposure: float) -> None:
        """Fill the active frame buffer.

        Parameters
        ----------
        sight : Sight
        turn : ndarray, shape (3, 3)
            Rotation from the world to that of its light.
        strength : float
            Factor of that light.
        frame : PictureFrame
        exposure : float
            Factor of radiance.
        """


class Backdrop(Behind):
    """An environment."""

    def __init__(self, environment: Environment) -> None:
        self.environment = environment
        self._map = map_texture("environment", environment.radiance)

    def draw(self, sight: Sight, turn: Array, strength: float, frame: PictureFrame, exposure: float) -> None:
        """See `Behind`."""
        pose: Array = np.eye(4)
        pose[:3, :3] = turn @ np.linalg.inv(sight.view[:3, :3])
        from_clip = pose @ np.linalg.inv(sight.projection)
        shader = backdrop_shader()
        shader.bind()
        shader.uniform_float("environment_from_clip", Matrix(from_clip.tolist()))
        shader.uniform_float("scale", strength * exposure)
        shader.uniform_sampler("environment", self._map.whole())
        with blended("NONE"):
            screen_triangle(shader).draw(shader)


class PictureBackdrop(Behind):
    """A picture whose middle fills a frame.

    Parameters
    ----------
    radiance : ndarray, shape (height, width, 3)
        Row 0 at the bottom.
    """

    def __init__(self, radiance: Array) -> None:
        self._picture = GpuTexture("picture behind the objects", with_alpha(radiance))
        self._aspect = radiance.shape[1] / radiance.shape[0]

    def draw(self, sight: Sight, turn: Array, strength: float, frame: PictureFrame, exposure: float) -> None:
        """See `Behind`."""
        from_clip, part = frame.projection @ np.linalg.inv(sight.projection), frame.aspect / self._aspect
        shown = np.array([min(part, 1.0), min(1.0 / part, 1.0)])
        shader = picture_backdrop_shader()
        shader.bind()
        shader.uniform_float("size", 0.5 * shown * np.diag(from_clip)[:2])
        shader.uniform_float("middle", 0.5 + 0.5 * shown * from_clip[:2, 3])
        shader.uniform_float("scale", exposure)
        shader.uniform_sampler("picture", self._picture.whole())
        with blended("NONE"):
            screen_triangle(shader).draw(shader)


@kept_until_exit
def backdrop_shader() -> gpu.types.GPUShader:
    """Draws an environment behind all surfaces."""
    info = screen_interface()
    info.push_constant("MAT4", "environment_from_clip")
    info.push_constant("FLOAT", "scale")
    info.sampler(0, "FLOAT_2D", "environment")
    info.fragment_out(0, "VEC4", "colour")
    return build("backdrop", info, "screen_vert.glsl", "backdrop_frag.glsl")


@kept_until_exit
def picture_backdrop_shader() -> gpu.types.GPUShader:
    """Draws a picture behind all surfaces."""
    info = screen_interface()
    info.push_constant("VEC2", "size")
    info.push_constant("VEC2", "middle")
    info.push_constant("FLOAT", "scale")
    info.sampler(0, "FLOAT_2D", "picture")
    info.fragment_out(0, "VEC4", "colour")
    return build("picture_backdrop", info, "screen_vert.glsl", "picture_backdrop_frag.glsl")
