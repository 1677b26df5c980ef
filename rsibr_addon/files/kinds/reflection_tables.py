"""Map sets of kind `reflection_tables`."""

from functools import partial
from pathlib import Path
from typing import Any, TypedDict

import numpy as np

from ...core.errors import MapSetError, RangeError, ShapeError
from ...core.kinds.reflection_tables.material import PARTS
from ...core.kinds.reflection_tables.shading import TablesLook, reflect_tables
from ...core.kinds.reflection_tables.tables import ReflectionTables, Role
from ...settings.reflection_tables import ReflectionTablesSettings, TablesComparison
from ..map_set_data import ENVIRONMENT, MapSet
from ..map_set_header import Origin, Shading, StoredKind, make_header

KIND = "reflection_tables"
WEIGHTS = "weights"
"""The role of the part that holds the weights, and its name."""


class _Weights(TypedDict):
    rows: list[str]


class _Refraction(TypedDict):
    eta: float


def to_map_set(tables: ReflectionTables, origin: Origin) -> MapSet:
    """Reflection tables as a map set holds them."""
    maps = {ENVIRONMENT: origin.environment.radiance, WEIGHTS: tables.weights}
    maps |= {role.value: image for role, image in tables.maps.items()}
    parts: list[dict[str, Any]] = [{"name": name, "role": name} for name in maps]
    for part in parts:
        if part["role"] == WEIGHTS:
            part["rows"] = [role.value for role in Role]
        elif part["role"] == Role.REFRACTION:
            part["eta"] = tables.eta
    height = max(len(image) for image in tables.maps.values())
    header = make_header("equirect", (2 * height, height), parts, origin)
    return MapSet(KIND, maps, header)


def from_map_set(path: Path, map_set: MapSet) -> ReflectionTables:
    """Reflection tables as a map set holds them.

    Raises
    ------
    MapSetError
        It is not laid out as latitude-longitude maps, holds two tables of one role or none at all, or
        lacks weights, or a row of them for each table.
    """
    layout = map_set.header["layout"]
    if layout != "equirect":
        raise MapSetError(f"{path} holds tables laid out as {layout}, not as equirect: make it again.")
    parts = {part["role"]: part for part in map_set.header["parts"]}
    there = {role: parts[role] for role in Role if role in parts}
    # Unknown roles do no harm, but of two parts with one known role, one would hide the other.
    if (
        sum(part["role"] in there or part["role"] == WEIGHTS for part in map_set.header["parts"])
        != len(there) + 1
    ):
        raise MapSetError(f"{path} lacks its weights or holds two parts of one role: make it again.")
    weights, rows = map_set.maps[parts[WEIGHTS]["name"]], parts[WEIGHTS]["rows"]
    if len(rows) != len(weights) or not set(there) <= set(rows):
        raise MapSetError(f"{path} lacks the weights of one of its tables: make it again.")
    ordered = np.zeros((len(Role), *weights.shape[1:]), dtype=np.float32)
    for row, role in zip(ordered, Role, strict=True):
        if role in there:
            row[:] = weights[rows.index(role)]
    eta = there[Role.REFRACTION]["eta"] if Role.REFRACTION in there else 1.0
    try:
        return ReflectionTables(
            {role: map_set.maps[part["name"]] for role, part in there.items()},
            ordered,
            eta,
            {part: text for part, text in map_set.header["material"].items() if part in PARTS},
        )
    except (RangeError, ShapeError) as error:
        raise MapSetError(f"{path} holds no reflection tables. {error}") from error


def _shading(path: Path, map_set: MapSet) -> Shading:
    return partial(reflect_tables, from_map_set(path, map_set), look=TablesLook())


STORED = StoredKind(
    settings=ReflectionTablesSettings,
    look=TablesLook,
    comparison=TablesComparison,
    roles={WEIGHTS: _Weights, Role.REFRACTION: _Refraction},
    numbers=(WEIGHTS,),
    painted=tuple(Role),
    from_map_set=from_map_set,
    shading=_shading,
)
