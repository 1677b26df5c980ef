"""Reflection tables to map sets and back, and what is refused on the way."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rsibr.rsibr_addon.core.environment import Environment
from rsibr.rsibr_addon.core.errors import MapSetError
from rsibr.rsibr_addon.core.kinds.reflection_tables.tables import ReflectionTables, Role
from rsibr.rsibr_addon.files.kinds.reflection_tables import KIND, from_map_set, to_map_set
from rsibr.rsibr_addon.files.map_set import read_map_set, write_map_set
from rsibr.rsibr_addon.files.map_set_data import MapSet
from rsibr.rsibr_addon.files.map_set_header import Origin

PATH = Path("a.rsibr.exr")


def random_tables(roles: tuple[Role, ...] = tuple(Role), eta: float = 1.5) -> ReflectionTables:
    rng = np.random.default_rng(1)
    maps = {role: rng.random((3 + i, 6 + 2 * i, 3), dtype=np.float32) for i, role in enumerate(roles)}
    weights = rng.random((len(Role), 7, 3), dtype=np.float32)
    for row, role in zip(weights, Role, strict=True):
        row *= role in roles
    return ReflectionTables(maps, weights, eta)


def map_set_of(tables: ReflectionTables) -> MapSet:
    environment = Environment(np.ones((4, 8, 3), np.float32), "grey.exr")
    bound = {"specular": [1e-5, 2e-5, 3e-5]}
    origin = Origin(environment, {"exact": False}, "tests", {"diffuse": "lambert:kd=1"}, bound)
    return to_map_set(tables, origin)


@pytest.mark.parametrize("roles", [tuple(Role), (Role.DIFFUSE,), (Role.RETRO, Role.REFRACTION)])
def test_tables_come_back_as_they_were(tmp_path: Path, roles: tuple[Role, ...]) -> None:
    eta = 1.25 if Role.REFRACTION in roles else 1.0
    tables = random_tables(roles, eta)
    write_map_set(tmp_path / PATH, map_set_of(tables))
    back = from_map_set(PATH, read_map_set(tmp_path / PATH, KIND))
    assert list(back.maps) == list(roles)
    for role in roles:
        np.testing.assert_array_equal(back.maps[role], tables.maps[role])
    np.testing.assert_array_equal(back.weights, tables.weights)
    assert back.eta == eta


def test_the_description_tells_what_the_parts_are() -> None:
    header = map_set_of(random_tables()).header
    assert header["layout"] == "equirect"
    assert header["size"] == [14, 7]  # the largest
    assert header["environment"]["part"] == "environment"
    assert header["material"] == {"diffuse": "lambert:kd=1"}
    names = [part["name"] for part in header["parts"]]
    assert names == ["environment", "weights", "diffuse", "specular", "coat", "retro", "refraction"]
    by_name = {part["name"]: part for part in header["parts"]}
    assert by_name["weights"]["rows"] == ["diffuse", "specular", "coat", "retro", "refraction"]
    assert by_name["refraction"]["eta"] == 1.5


def test_rows_of_weights_go_by_their_names() -> None:
    tables = random_tables((Role.DIFFUSE, Role.COAT))
    written = map_set_of(tables)
    maps = written.maps | {"weights": tables.weights[[2, 0]]}
    parts = [
        part | {"rows": ["coat", "diffuse"]} if part["role"] == "weights" else part
        for part in written.header["parts"]
    ]
    other = replace(written, maps=maps, header=written.header | {"parts": parts})
    np.testing.assert_array_equal(from_map_set(PATH, other).weights, tables.weights)


Change = Callable[[dict[str, Any], dict[str, np.ndarray]], None]


def lay_out_as_cubes(header: dict[str, Any], maps: dict[str, np.ndarray]) -> None:
    header["layout"] = "cube_map"


def drop_weights(header: dict[str, Any], maps: dict[str, np.ndarray]) -> None:
    header["parts"] = [part for part in header["parts"] if part["role"] != "weights"]


def repeat_a_role(header: dict[str, Any], maps: dict[str, np.ndarray]) -> None:
    header["parts"] += [{"name": "again", "role": "diffuse"}]
    maps["again"] = maps["diffuse"]


def forget_a_row(header: dict[str, Any], maps: dict[str, np.ndarray]) -> None:
    header["parts"][1]["rows"] = ["diffuse", "specular", "coat", "retro", "more"]


def drop_tables(header: dict[str, Any], maps: dict[str, np.ndarray]) -> None:
    header["parts"] = header["parts"][:2]


def square_a_table(header: dict[str, Any], maps: dict[str, np.ndarray]) -> None:
    maps["diffuse"] = maps["diffuse"][:, :3]


def bend_backwards(header: dict[str, Any], maps: dict[str, np.ndarray]) -> None:
    header["parts"][-1]["eta"] = -1.0


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (lay_out_as_cubes, r"a\.rsibr\.exr holds tables laid out as cube_map, not as equirect: make"),
        (drop_weights, "lacks its weights or holds two parts of one role: make it again"),
        (repeat_a_role, "lacks its weights or holds two parts of one role: make it again"),
        (forget_a_row, "lacks the weights of one of its tables: make it again"),
        (drop_tables, r"holds no reflection tables\. Reflection tables need at least one map"),
        (square_a_table, r"holds no reflection tables\. The diffuse table must have the shape"),
        (bend_backwards, r"holds no reflection tables\. An index of refraction cannot be -1"),
    ],
)
def test_what_is_not_whole_is_refused(change: Change, sentence: str) -> None:
    map_set = map_set_of(random_tables())
    change(map_set.header, map_set.maps)
    with pytest.raises(MapSetError, match=sentence):
        from_map_set(PATH, map_set)


@pytest.mark.parametrize(("part", "field"), [("weights", "rows"), ("refraction", "eta")])
def test_parts_must_say_what_they_are(tmp_path: Path, part: str, field: str) -> None:
    map_set = map_set_of(random_tables())
    (described,) = (each for each in map_set.header["parts"] if each["role"] == part)
    del described[field]
    with pytest.raises(MapSetError, match=rf"\.{field} is missing"):
        write_map_set(tmp_path / PATH, map_set)
    described[field] = {"no": "such"}
    with pytest.raises(MapSetError, match=rf"\.{field} is not a"):
        write_map_set(tmp_path / PATH, map_set)
