"""Reflection tables on the GPU [Miller1984]: a texture for each, looked up for each fragment."""

from functools import cached_property

import numpy as np

from ...core.kinds.reflection_tables.shading import MIRRORED, TablesLook
from ...core.kinds.reflection_tables.tables import ReflectionTables, Role
from .. import buffers
from ..drawing import Inputs, ProgramMapSet
from ..equirect import Sums, map_sums, map_texture, no_map, no_sums
from ..shaders import MeshProgram
from ..textures import GpuTexture

# A factor for each table, in the order of `Role`; the index of refraction; factors for tables of `MIRRORED`
# that count by their means over a pixel; and the units of these tables' sums.
_FIELDS = (*(role.value for role in Role), "eta", *(f"{role}_mean" for role in MIRRORED))
_UNITS = " ".join(f"vec4 {role}_unit;" for role in MIRRORED)
_MAPS = dict.fromkeys([*(role.value for role in Role), "weights"], "FLOAT_2D")

reflection_tables_shader = MeshProgram(
    "reflection_tables",
    "Tables tables",
    f"{' '.join(f'float {field};' for field in _FIELDS)} {_UNITS}",
    _MAPS | {f"{role}_sums": "FLOAT_2D_ARRAY" for role in MIRRORED},
)
"""Draws a mesh from reflection tables."""


class GpuReflectionTables(ProgramMapSet):
    """A map set's reflection tables."""

    def __init__(self, tables: ReflectionTables) -> None:
        black = no_map()
        self._textures = {
            role: map_texture(f"{role} table", tables.maps[role]) if role in tables.maps else black
            for role in Role
        }
        self._weights = GpuTexture("table of weights", buffers.with_alpha(tables.weights))
        self.textures = (*self._textures.values(), self._weights)
        self._tables = tables
        self._no_sums = no_sums()

    @cached_property
    def _sums(self) -> dict[Role, Sums]:
        """The tables' sums, made for the first antialiased look: they take three times the tables' memory."""
        there = [role for role in MIRRORED if role in self._tables.maps]
        return {role: map_sums(self._tables.maps[role]) for role in there}

    def inputs(self, look: TablesLook) -> Inputs:
        """See `ProgramMapSet.inputs`. Reference: core/kinds/reflection_tables/shading.py."""
        averaged = self._sums if look.antialiased else {}
        factors = {role: look.weight(role) if role in self._tables.maps else 0.0 for role in Role}
        points = [0.0 if role in averaged else factor for role, factor in factors.items()]
        means = [factors[role] if role in averaged else 0.0 for role in MIRRORED]
        sums = {role: averaged.get(role, self._no_sums) for role in MIRRORED}
        numbers = np.array([*points, self._tables.eta, *means]).reshape(2, 4)
        textures = {role.value: texture for role, texture in self._textures.items()}
        textures |= {f"{role}_sums": each.texture for role, each in sums.items()}
        return Inputs(
            reflection_tables_shader,
            (numbers, *(each.unit for each in sums.values())),
            {**textures, "weights": self._weights},
        )
