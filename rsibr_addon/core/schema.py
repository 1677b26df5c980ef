"""JSON from outside: read strictly, and checked against annotated types before anything uses it.

A schema is a type. Plain types, lists, tuples, enumerations, `Literal` and `X | None` have their usual
meaning, and `Annotated[X, Rule(...)]` adds a rule. A `TypedDict` is an object that may have further fields;
it is returned as it is. A dataclass is an object without further fields; it is returned as an instance, which
checks itself.
"""

import dataclasses
import json
import math
import types
from collections.abc import Callable
from enum import Enum
from functools import cache
from typing import (
    Annotated,
    Any,
    Literal,
    NoReturn,
    NotRequired,
    TypeVar,
    Union,
    get_args,
    get_origin,
    get_type_hints,
    is_typeddict,
    overload,
)

import numpy as np

from .conventions import Array
from .errors import RangeError, SchemaError, ShapeError
from .near_names import did_you_mean

Decoded = TypeVar("Decoded")

LARGEST_TEXT = 8 * 2**20
"""Most bytes of JSON that are read: a few times the largest fit, and at most 200 MB of memory."""

DEEPEST = 32
"""Greatest depth of lists and objects within each other."""

LARGEST_INTEGER = 2**53
"""Largest whole number: up to it, every whole number is a float too."""

LARGEST_FLOAT = 1e60
"""Products of five such numbers are finite; no light is beyond it, as pictures hold 3e38 at most."""


@dataclasses.dataclass(frozen=True)
class Rule:
    """A rule for a value, beyond its type.

    Attributes
    ----------
    words : str
        The rule in words: "a unit vector".
    holds : callable
        Whether a value of the right type keeps the rule.
    """

    words: str
    holds: Callable[[Any], bool]


def between(low: float, high: float) -> Rule:
    """The rule of a number from `low` to `high`, both included."""
    return Rule(f"a number from {low:g} to {high:g}", lambda value: low <= value <= high)


def length(low: int, high: int) -> Rule:
    """The rule of a list, an object or a text with `low` to `high` members, both included."""
    words = f"{low}" if low == high else f"{low} to {high}"
    return Rule(f"{words} long", lambda value: low <= len(value) <= high)


def loads(text: str | bytes) -> Any:
    """Read strict JSON.

    Parameters
    ----------
    text : str or bytes
        In UTF-8, at most `LARGEST_TEXT` long.

    Returns
    -------
    object
        Numbers are finite, and whole ones at most `LARGEST_INTEGER`; no object has a name twice; every text
        can be written in UTF-8, without NUL, as names of files are; nothing is deeper than `DEEPEST`.

    Raises
    ------
    SchemaError
        The text is anything else.
    """
    if len(text) > LARGEST_TEXT:
        raise SchemaError(f"it is longer than {LARGEST_TEXT // 2**20} MiB")
    try:
        plain = json.loads(
            text, parse_constant=_refused, parse_float=_float, parse_int=_int, object_pairs_hook=_object
        )
    except (ValueError, RecursionError) as error:
        raise SchemaError(f"it is not JSON: {error}") from error
    _check_depth_and_texts(plain)
    return plain


@overload
def decode(schema: type[Decoded], plain: Any, where: str = "") -> Decoded: ...


@overload
def decode(schema: types.UnionType, plain: Any, where: str = "") -> Any: ...


def decode(schema: Any, plain: Any, where: str = "") -> Any:
    """The values of a schema's type that JSON values describe.

    Parameters
    ----------
    schema : type or union of types
        See the module's text.
    plain : object
        From `loads`.
    where : str
        Name of `plain` in messages; empty for a whole file.

    Returns
    -------
    object
        Value of that type.

    Raises
    ------
    SchemaError
        A value is missing, or is not what it must be; says which.
    """
    return _decoded(schema, plain, where)


def array(plain: Any, axes: int, where: str) -> Array:
    """Numbers in lists within lists, as an array.

    Parameters
    ----------
    plain : list
        Lists of numbers in so many levels, of a type that `decode` has checked.
    axes : int
        Number of levels.
    where : str
        Its name in messages.

    Returns
    -------
    ndarray, float64
        With `axes` axes.

    Raises
    ------
    SchemaError
        It is empty, or lists of one level have different lengths.
    """
    try:
        made = np.array(plain, dtype=np.float64)
    except ValueError as error:
        raise SchemaError(f"{where} has lists of different lengths") from error
    if made.ndim != axes or not made.size:
        raise SchemaError(f"{where} is empty")
    return made


def _refused(constant: str) -> NoReturn:
    raise SchemaError(f"it is not JSON: {constant} is no number there")


def _float(digits: str) -> float:
    number = float(digits)
    if not abs(number) <= LARGEST_FLOAT:
        raise SchemaError(f"the number {_shortened(digits)} is too large")
    return number


def _int(digits: str) -> int:
    if len(digits) > len(str(-LARGEST_INTEGER)) or abs(int(digits)) > LARGEST_INTEGER:
        raise SchemaError(f"the number {_shortened(digits)} is too large")
    return int(digits)


def _shortened(text: str) -> str:
    return text if len(text) <= 20 else f"{text[:16]}..."


def _object(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) < len(pairs):
        names = [name for name, _ in pairs]
        twice = next(name for name in names if names.count(name) > 1)
        raise SchemaError(f"{_shortened(twice)!r} appears twice")
    return found


def _check_depth_and_texts(plain: Any) -> None:
    level, depth = [plain], 0
    while level:
        if depth > DEEPEST:
            raise SchemaError(f"it is nested deeper than {DEEPEST} times")
        below: list[Any] = []
        for value in level:
            match value:
                case dict():
                    below += value
                    below += value.values()
                case list():
                    below += value
                case str():
                    if "\0" in value:
                        raise SchemaError(f"the text {_shortened(value)!a} holds a NUL")
                    # The halves of a character, which JSON can escape one by one, have no bytes
                    if not value.isascii() and any("\ud800" <= each <= "\udfff" for each in value):
                        raise SchemaError(f"the text {_shortened(value)!a} is half a character")
        level, depth = below, depth + 1


def _decoded(schema: Any, plain: Any, where: str) -> Any:
    if dataclasses.is_dataclass(schema):
        return _instance(schema, plain, where)
    if is_typeddict(schema):
        return _checked_object(schema, plain, where)
    origin, arguments = get_origin(schema), get_args(schema)
    if origin is NotRequired:
        return _decoded(arguments[0], plain, where)
    if origin is Annotated:
        return _ruled(arguments, plain, where)
    if origin in (Union, types.UnionType):
        return _first_that_fits(arguments, plain, where)
    if origin is list:
        return [_decoded(arguments[0], each, f"{where}[{i}]") for i, each in enumerate(_list(plain, where))]
    if origin is tuple:
        return _tuple(arguments, plain, where)
    if origin is dict:
        members = _of_type(dict, plain, where).items()
        return {name: _decoded(arguments[1], each, _within(where, name)) for name, each in members}
    if origin is Literal:
        return _one_of(arguments, plain, where)
    if isinstance(schema, type) and issubclass(schema, Enum):
        return schema(_one_of([member.value for member in schema], plain, where))
    return plain if schema is Any else _of_type(schema, plain, where)


_WORDS = {
    str: "text",
    int: "a whole number",
    float: "a finite number",
    bool: "true or false",
    list: "a list",
    dict: "an object",
    types.NoneType: "null",
}


def _of_type(schema: Any, plain: Any, where: str) -> Any:
    accepted = (int, float) if schema is float else schema or types.NoneType
    # A bool is an int to Python
    fits = isinstance(plain, accepted) and (schema is bool or not isinstance(plain, bool))
    if not fits or (schema is float and not math.isfinite(plain)):
        raise _refusal(where, _WORDS[schema or types.NoneType])
    return float(plain) if schema is float else plain


def _list(plain: Any, where: str) -> list[Any]:
    listed: list[Any] = _of_type(list, plain, where)
    return listed


def _one_of(values: Any, plain: Any, where: str) -> Any:
    for value in values:
        if type(value) is type(plain) and value == plain:
            return value
    raise _refusal(where, f"one of {', '.join(map(str, values))}" if len(values) > 1 else str(values[0]))


def _ruled(arguments: tuple[Any, ...], plain: Any, where: str) -> Any:
    schema, *rules = arguments
    decoded = _decoded(schema, plain, where)
    for rule in rules:
        if not rule.holds(decoded):
            raise _refusal(where, rule.words)
    return decoded


def _first_that_fits(schemas: tuple[Any, ...], plain: Any, where: str) -> Any:
    if plain is None and types.NoneType in schemas:
        return None
    *first, last = (schema for schema in schemas if schema is not types.NoneType)
    for schema in first:
        try:
            return _decoded(schema, plain, where)
        except SchemaError:
            continue
    return _decoded(last, plain, where)


def _tuple(arguments: tuple[Any, ...], plain: Any, where: str) -> tuple[Any, ...]:
    listed = _list(plain, where)
    schemas = [arguments[0]] * len(listed) if arguments[-1] is Ellipsis else arguments
    if len(schemas) != len(listed):
        raise _refusal(where, f"{len(schemas)} long")
    return tuple(
        _decoded(schema, each, f"{where}[{i}]")
        for i, (schema, each) in enumerate(zip(schemas, listed, strict=True))
    )


def _checked_object(schema: Any, plain: Any, where: str) -> Any:
    found = _of_type(dict, plain, where)
    for name, kind in _hints(schema).items():
        if name in found:
            _decoded(kind, found[name], _within(where, name))
        elif name in schema.__required_keys__:
            raise SchemaError(f"{_within(where, name)} is missing")
    return found


def _instance(schema: Any, plain: Any, where: str) -> Any:
    found, hints = _of_type(dict, plain, where), _hints(schema)
    for field in dataclasses.fields(schema):
        needed = field.default is field.default_factory is dataclasses.MISSING
        if needed and field.name not in found:
            raise SchemaError(f"{_within(where, field.name)} is missing")
    for name in found:
        if name not in hints:
            short = _shortened(name)
            raise SchemaError(f"{_within(where, short)} is unknown{did_you_mean(short, hints)}")
    values = {name: _decoded(hints[name], value, _within(where, name)) for name, value in found.items()}
    try:
        return schema(**values)
    except (RangeError, ShapeError) as error:
        raise SchemaError(f"{where or 'it'} is impossible: {str(error).rstrip('.')}") from error


@cache
def _hints(schema: Any) -> dict[str, Any]:
    return get_type_hints(schema, include_extras=True)


def _within(where: str, name: str) -> str:
    return f"{where}.{name}" if where else name


def _refusal(where: str, words: str) -> SchemaError:
    return SchemaError(f"{where or 'it'} is not {words}")
