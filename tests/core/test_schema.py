"""JSON from outside: what is good comes back, and all else is told by its name."""

import json
from dataclasses import dataclass
from enum import StrEnum
from typing import Annotated, Any, Literal, NotRequired, TypedDict

import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import RangeError, SchemaError
from rsibr.rsibr_addon.core.schema import (
    DEEPEST,
    LARGEST_FLOAT,
    LARGEST_INTEGER,
    LARGEST_TEXT,
    Rule,
    array,
    between,
    decode,
    length,
    loads,
)


class Light(StrEnum):
    """An enumeration."""

    SUN = "sun"
    SKY = "sky"


@dataclass(frozen=True)
class Lamp:
    """An object without further fields."""

    power: Annotated[float, between(0.0, 10.0)]
    light: Light = Light.SUN
    colour: tuple[float, float, float] | None = None
    seeds: tuple[int, ...] = ()

    def __post_init__(self) -> None:
        if self.power == 7.0:
            raise RangeError("A lamp cannot have a power of 7: choose another.")


class Scene(TypedDict):
    """An object that may have further fields."""

    format: Literal[1]
    name: Annotated[str, length(1, 8)]
    lamps: list[Lamp]
    even: NotRequired[Annotated[int, Rule("an even number", lambda value: value % 2 == 0)]]
    extra: NotRequired[dict[str, bool]]


@pytest.mark.parametrize(
    "value",
    [
        None,
        -0.0,
        "Wald über \N{SNOWMAN} \N{GRINNING FACE}",
        [LARGEST_INTEGER, -LARGEST_INTEGER, LARGEST_FLOAT, 5e-324],
        {"a": {"b": [[], {}, True, False]}},
    ],
)
def test_what_json_writes_comes_back(value: Any) -> None:
    assert repr(loads(json.dumps(value))) == repr(value)
    assert repr(loads(json.dumps(value).encode())) == repr(value)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("", "it is not JSON: Expecting value"),
        ("{'a': 1}", "it is not JSON: "),
        (b"\xff", "it is not JSON: "),
        ("[" * 10**6, "it is not JSON: "),
        ("[" * (DEEPEST + 2) + "]" * (DEEPEST + 2), "it is nested deeper than 32 times"),
        ('{"a": [NaN]}', "it is not JSON: NaN is no number there"),
        ("-Infinity", "it is not JSON: -Infinity is no number there"),
        ("1e999", "the number 1e999 is too large"),
        ("-1.1e60", "the number -1.1e60 is too large"),
        (str(LARGEST_INTEGER + 1), "the number 9007199254740993 is too large"),
        ("-" + "9" * 5000, "the number -999999999999999... is too large"),
        ('{"a": 1, "b": 2, "a": 1}', "'a' appears twice"),
        (r'["\ud800"]', "is half a character"),
        (r'{"\udfff": 1}', "is half a character"),
        (r'["a\u0000b"]', "the text 'a\\x00b' holds a NUL"),
        (" " * LARGEST_TEXT + "1", "it is longer than 8 MiB"),
    ],
)
def test_what_is_not_json_is_refused(text: str | bytes, why: str) -> None:
    with pytest.raises(SchemaError) as caught:
        loads(text)
    assert why in str(caught.value)
    assert len(str(caught.value)) < 100


def test_a_dataclass_comes_back_as_an_instance() -> None:
    plain = {"power": 3, "light": "sky", "colour": [1, 0.5, 0], "seeds": [1, 2]}
    lamp = decode(Lamp, plain)
    assert lamp == Lamp(3.0, Light.SKY, (1.0, 0.5, 0.0), (1, 2))
    assert isinstance(lamp.power, float)
    assert isinstance(lamp.light, Light)
    assert decode(Lamp, {"power": 1.0, "colour": None}) == Lamp(1.0)


def test_an_object_comes_back_as_it_is_with_what_is_not_known() -> None:
    plain = {"format": 1, "name": "a", "lamps": [{"power": 1}], "more": [None]}
    assert decode(Scene, plain) is plain
    assert plain["lamps"] == [{"power": 1}]


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ({"format": True}, "format is not 1"),
        ({"format": 1.0}, "format is not 1"),
        ({"name": 3}, "name is not text"),
        ({"name": ""}, "name is not 1 to 8 long"),
        ({"lamps": {}}, "lamps is not a list"),
        ({"lamps": [None]}, "lamps[0] is not an object"),
        ({"lamps": [{}]}, "lamps[0].power is missing"),
        ({"lamps": [{"power": "1"}]}, "lamps[0].power is not a finite number"),
        ({"lamps": [{"power": True}]}, "lamps[0].power is not a finite number"),
        ({"lamps": [{"power": np.inf}]}, "lamps[0].power is not a finite number"),
        ({"lamps": [{"power": -1}]}, "lamps[0].power is not a number from 0 to 10"),
        ({"lamps": [{"power": 7}]}, "lamps[0] is impossible: A lamp cannot have a power of 7"),
        ({"lamps": [{"power": 1, "light": []}]}, "lamps[0].light is not one of sun, sky"),
        ({"lamps": [{"power": 1, "colour": [1]}]}, "lamps[0].colour is not 3 long"),
        ({"lamps": [{"power": 1, "colour": [1, 2, "3"]}]}, "lamps[0].colour[2] is not a finite number"),
        ({"lamps": [{"power": 1, "seeds": [1.5]}]}, "lamps[0].seeds[0] is not a whole number"),
        ({"lamps": [{"power": 1, "more": 0}]}, "lamps[0].more is unknown"),
        ({"even": 3}, "even is not an even number"),
        ({"extra": {"a": 1}}, "extra.a is not true or false"),
    ],
)
def test_what_does_not_fit_is_named(change: dict[str, Any], why: str) -> None:
    with pytest.raises(SchemaError) as caught:
        decode(Scene, {"format": 1, "name": "a", "lamps": [], **change})
    assert str(caught.value).startswith(why)


@pytest.mark.parametrize("value", [None, 3, "a", [], {"a": "b"}])
def test_the_first_type_that_fits_is_taken(value: Any) -> None:
    assert decode(int | str | list[int] | dict[str, str] | None, value) == value


def test_arrays_are_regular() -> None:
    np.testing.assert_array_equal(array([[1, 2], [3, 4.5]], 2, "a"), [[1.0, 2.0], [3.0, 4.5]])
    for plain, axes, why in (
        ([[1.0], [1.0, 2.0]], 2, "a has lists of different lengths"),
        ([[1.0], []], 2, "a has lists of different lengths"),
        ([], 2, "a is empty"),
        ([[]], 2, "a is empty"),
    ):
        with pytest.raises(SchemaError, match=why):
            array(plain, axes, "a")
