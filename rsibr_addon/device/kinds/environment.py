"""An environment on the GPU, for mirrors."""

import numpy as np

from ...core.environment import Environment
from ...core.kinds.environment import EnvironmentLook
from .. import buffers
from ..drawing import Draw, GpuMesh
from ..equirect import map_sums, map_texture, no_sums
from ..shaders import mesh_program

environment_shader = mesh_program(
    "environment",
    "EnvironmentLook look",
    "vec4 f0; vec4 unit; float antialiased; float unused_0; float unused_1; float unused_2;",
    {"environment": "FLOAT_2D", "sums": "FLOAT_2D_ARRAY"},
)
"""Draws a mesh as a mirror."""


class GpuEnvironment:
    """An environment, and its sums, as mirrors are antialiased unless one asks for points."""

    def __init__(self, environment: Environment) -> None:
        self._map = map_texture("environment", environment.radiance)
        self._sums, self._no_sums = map_sums(environment.radiance), no_sums()
        self.textures = (self._map, self._sums.texture)
        self._look = buffers.KeptBlock()

    def draw(self, mesh: GpuMesh, draw: Draw, look: EnvironmentLook) -> None:
        """See `GpuMapSet.draw`. Reference: core/kinds/environment.py."""
        sums = self._sums if look.antialiased else self._no_sums
        antialiased = np.array([float(look.antialiased)])
        shader = environment_shader()
        shader.bind()
        shader.uniform_block("look", self._look.filled(np.array(look.f0), sums.unit, antialiased))
        shader.uniform_sampler("environment", self._map.whole())
        shader.uniform_sampler("sums", sums.texture.whole())
        mesh.draw(shader, draw)
