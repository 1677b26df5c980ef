"""An environment on the GPU, for mirrors."""

import numpy as np

from ...core.environment import Environment
from ...core.kinds.environment import EnvironmentLook
from ..drawing import Inputs, ProgramMapSet
from ..equirect import averaging_number, map_sums, map_texture, no_sums
from ..shaders import MeshProgram

environment_shader = MeshProgram(
    "environment",
    "EnvironmentLook look",
    "vec4 f0; vec4 unit; float antialiased; float averaging; float unused_0; float unused_1;",
    {"environment": "FLOAT_2D", "sums": "FLOAT_2D_ARRAY"},
)
"""Draws a mesh as a mirror."""


class GpuEnvironment(ProgramMapSet):
    """An environment, and its sums, as mirrors are antialiased unless one asks for points."""

    def __init__(self, environment: Environment) -> None:
        self._map = map_texture("environment", environment.radiance)
        self._sums, self._no_sums = map_sums(environment.radiance), no_sums()
        self.textures = (self._map, self._sums.texture)

    def inputs(self, look: EnvironmentLook) -> Inputs:
        """See `ProgramMapSet.inputs`. Reference: core/kinds/environment.py."""
        sums = self._sums if look.antialiased else self._no_sums
        fields = (
            np.array(look.f0),
            sums.unit,
            np.array([float(look.antialiased), averaging_number(look.averaging)]),
        )
        textures = {"environment": self._map, "sums": sums.texture}
        summed = {"sums": ("environment", sums.unit)} if look.antialiased else {}
        return Inputs(environment_shader, fields, textures, summed)
