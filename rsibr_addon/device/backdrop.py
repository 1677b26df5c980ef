"""An environment behind all surfaces."""

import gpu
import numpy as np
from mathutils import Matrix

from ..core.conventions import Array
from ..core.environment import Environment
from .equirect import map_texture
from .passes import blended, screen_interface, screen_triangle
from .preview_stage import Sight
from .shaders import build, kept_until_exit


class Backdrop:
    """An environment, to be drawn behind all surfaces; nothing of it is on the GPU at first."""

    def __init__(self, environment: Environment) -> None:
        self._map = map_texture("environment", environment.radiance)

    def draw(self, sight: Sight, turn: Array, scale: float) -> None:
        """Fill the active frame buffer.

        Parameters
        ----------
        sight : Sight
        turn : ndarray, shape (3, 3)
            Rotation from the world to that of the environment.
        scale : float
            Factor of radiance.
        """
        pose: Array = np.eye(4)
        pose[:3, :3] = turn @ np.linalg.inv(sight.view[:3, :3])
        from_clip = pose @ np.linalg.inv(sight.projection)
        shader = backdrop_shader()
        shader.bind()
        shader.uniform_float("environment_from_clip", Matrix(from_clip.tolist()))
        shader.uniform_float("scale", scale)
        shader.uniform_sampler("environment", self._map.whole())
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
