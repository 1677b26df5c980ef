"""An environment on the GPU, for mirrors."""

from functools import cached_property

import numpy as np

from ...core.environment import Environment
from ...core.kinds.environment import EnvironmentLook
from .. import buffers
from ..drawing import Draw, GpuMesh
from ..equirect import Sums, map_sums, map_texture, no_sums
from ..shaders import mesh_program

environment_shader = mesh_program(
    "environment",
    "EnvironmentLook look",
    "vec4 f0; vec4 unit; float antialiased; float unused_0; float unused_1; float unused_2;",
    {"environment": "FLOAT_2D", "sums": "FLOAT_2D_ARRAY"},
)
"""Draws a mesh as a mirror."""


class GpuEnvironment:
    """An uploaded environment; its sums follow when the first antialiased look is drawn.

    Raises
    ------
    DeviceError
        The environment is larger than the device takes.
    """

    def __init__(self, environment: Environment) -> None:
        self._environment = environment
        self._map = map_texture("environment", environment.radiance)
        self._no_sums = no_sums()
        self._look = buffers.KeptBlock()

    @cached_property
    def _sums(self) -> Sums:
        return map_sums(self._environment.radiance)

    def draw(self, mesh: GpuMesh, draw: Draw, look: EnvironmentLook) -> None:
        """See `GpuMapSet.draw`. Reference: core/kinds/environment.py."""
        sums = self._sums if look.antialiased else self._no_sums
        antialiased = np.array([float(look.antialiased)])
        shader = environment_shader()
        shader.bind()
        shader.uniform_block("look", self._look.filled(np.array(look.f0), sums.unit, antialiased))
        shader.uniform_sampler("environment", self._map)
        shader.uniform_sampler("sums", sums.texture)
        mesh.draw(shader, draw)
