"""Reflection tables on the GPU [Miller1984]: a texture for each, looked up for each fragment."""

from dataclasses import replace
from functools import cache

import numpy as np

from ...core.conventions import Array
from ...core.kinds.reflection_tables.changes import emitted_radiance
from ...core.kinds.reflection_tables.shading import AVERAGED, TablesLook
from ...core.kinds.reflection_tables.tables import ReflectionTables, Role
from .. import buffers
from ..drawing import Draw, GpuMesh, Inputs, ProgramMapSet
from ..equirect import averaging_number, map_sums, map_texture, no_map, no_sums
from ..shaders import MeshProgram
from ..textures import GpuTexture

# Factors of each table, in the order of `Role`; what is added to the diffuse one; the units of the sums of
# those of `AVERAGED`; the index of refraction, 1 where they are averaged, and how.
_FACTORS = " ".join(f"vec4 {role};" for role in Role)
_UNITS = " ".join(f"vec4 {role}_unit;" for role in AVERAGED)
_MAPS = dict.fromkeys([*(role.value for role in Role), "weights"], "FLOAT_2D")


@cache
def tables_program(missing: tuple[Role, ...] = ()) -> MeshProgram:
    """What draws a mesh from reflection tables; missing: those of `AVERAGED` that are not there."""
    return MeshProgram(
        "reflection_tables",
        "Tables tables",
        f"{_FACTORS} vec4 added; {_UNITS} float eta; float antialiased; float averaging; float unused_0;",
        _MAPS | {f"{role}_sums": "FLOAT_2D_ARRAY" for role in AVERAGED},
        [f"NO_{role.upper()}" for role in missing],
    )


LOOKS = 8
"""Looks that weights are kept of: every frame asks for those of all objects."""

UNCHANGED = np.ones(3)
"""Gain of a table that is shown as it was baked."""


class GpuReflectionTables(ProgramMapSet):
    """A map set's reflection tables, and their sums, as looks are antialiased unless one asks for points."""

    def __init__(self, tables: ReflectionTables) -> None:
        black = no_map()
        self._textures = {
            role: map_texture(f"{role} table", tables.maps[role]) if role in tables.maps else black
            for role in Role
        }
        self._weights = _weights(tables)
        self._sums = {role: map_sums(tables.maps[role]) for role in AVERAGED if role in tables.maps}
        summed = (each.texture for each in self._sums.values())
        self.textures = (*self._textures.values(), self._weights, *summed)
        self._tables = tables
        self._looks: dict[TablesLook, tuple[ReflectionTables, GpuTexture]] = {}
        self._no_sums = no_sums()
        self._program = tables_program(tuple(role for role in AVERAGED if role not in tables.maps))

    def inputs(self, look: TablesLook) -> Inputs:
        """See `ProgramMapSet.inputs`.

        Raises
        ------
        RangeError
            See `TablesLook.changes`.

        Notes
        -----
        Reference: core/kinds/reflection_tables/shading.py.
        """
        tables, weights = self._as_looked_at(look)
        sums = dict.fromkeys(AVERAGED, self._no_sums) | (self._sums if look.antialiased else {})
        fields = (
            *(_factor(tables, look, role) for role in Role),
            look.weight(Role.DIFFUSE) * tables.added,
            *(each.unit for each in sums.values()),
            np.array([tables.eta, float(look.antialiased), averaging_number(look.averaging)]),
        )
        textures = {role.value: texture for role, texture in self._textures.items()}
        textures |= {f"{role}_sums": each.texture for role, each in sums.items()}
        summed = {f"{role}_sums": (role.value, each.unit) for role, each in sums.items() if look.antialiased}
        return Inputs(self._program, fields, {**textures, "weights": weights}, summed)

    def refracts(self, look: TablesLook) -> bool:
        """See `Refractive`."""
        return (
            look.antialiased and Role.REFRACTION in self._tables.maps and look.weight(Role.REFRACTION) > 0.0
        )

    def draw_emission(self, mesh: GpuMesh, draw: Draw, look: TablesLook) -> None:
        """See `Emissive`."""
        tables, _ = self._as_looked_at(look)
        inputs = self.inputs(look)
        _, *others = inputs.fields[len(Role) :]
        emitted = look.weight(Role.DIFFUSE) * emitted_radiance(tables.parts)
        self._draw(mesh, draw, replace(inputs, fields=(*[np.zeros(3)] * len(Role), emitted, *others)))

    def _as_looked_at(self, look: TablesLook) -> tuple[ReflectionTables, GpuTexture]:
        """The tables as a look changes them, and their weights."""
        found = self._looks.pop(look, None)
        if found is None:
            tables = look.changes(self._tables)
            found = tables, self._weights if tables is self._tables else _weights(tables)
        self._looks[look] = found  # the newest last
        if len(self._looks) > LOOKS:
            del self._looks[next(iter(self._looks))]
        return found


def _weights(tables: ReflectionTables) -> GpuTexture:
    return GpuTexture("table of weights", buffers.with_alpha(tables.weights))


def _factor(tables: ReflectionTables, look: TablesLook, role: Role) -> Array:
    """0 where a table is missing or not shown, shape (3,)."""
    there = look.weight(role) if role in tables.maps else 0.0
    return there * tables.gains.get(role, UNCHANGED)
