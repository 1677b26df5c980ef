"""A batch as a table in CSV: a bake, or a pattern of bakes, a row."""

import csv
import io
from collections.abc import Iterator
from typing import Any

from ...core.errors import SchemaError
from ...core.near_names import did_you_mean
from ...core.options import declared_options, value_from_text
from ...files.kinds.registry import STORED

FLAGS = {"true": True, "yes": True, "1": True, "false": False, "no": False, "0": False}
"""Cells of a setting that is on or off."""


def rows_of(text: str) -> Iterator[dict[str, Any]]:
    """A batch's fields for each row of a table.

    Parameters
    ----------
    text : str
        The first line names the columns. They are parted by commas; or by semicolons, as Excel parts them in
        countries with a decimal comma, which numbers then may have.

    Raises
    ------
    SchemaError
        Says in which line what is wrong.
    """
    first = text.partition("\n")[0]
    has_decimal_commas = first.count(";") > first.count(",")
    table = csv.DictReader(io.StringIO(text), delimiter=";" if has_decimal_commas else ",")
    table.fieldnames = [name.strip().lower() for name in table.fieldnames or ()]
    for row in table:
        line = table.line_num
        if None in row:
            raise SchemaError(
                f"line {line} has more cells than columns: put quotes around a cell with commas"
            )
        cells = {name: cell.strip() for name, cell in row.items() if name and cell and cell.strip()}
        if cells:
            yield _fields(cells, line, has_decimal_commas)


def method_kind(name: str) -> str:
    """The kind of map sets that a method of this name makes.

    Raises
    ------
    SchemaError
        There is no such method.
    """
    kind = name.replace("-", "_")
    if kind not in STORED:
        known = [each.replace("_", "-") for each in STORED]
        near = did_you_mean(name, known)
        raise SchemaError(f"there is no method {name}{near}: choose one of {', '.join(known)}")
    return kind


def _fields(cells: dict[str, str], line: int, has_decimal_commas: bool) -> dict[str, Any]:
    try:
        environment, method = cells.pop("environment"), cells.pop("method")
    except KeyError as error:
        raise SchemaError(f"line {line} has no {error.args[0]}") from error
    fields: dict[str, Any] = {"environments": (environment,)}
    if "material" in cells:
        fields["materials"] = (cells.pop("material"),)
    if "output" in cells:
        fields["output"] = cells.pop("output")
    if "clamp" in cells:
        fields["clamp"] = _number(cells.pop("clamp"), line, has_decimal_commas)
    return fields | {
        "methods": ({"kind": method} | _values(method_kind(method), cells, line, has_decimal_commas),)
    }


def _number(text: str, line: int, has_decimal_comma: bool) -> float:
    try:
        return float(_with_point(text) if has_decimal_comma else text)
    except ValueError:
        raise SchemaError(f"clamp of line {line} is not a number") from None


def _values(kind: str, cells: dict[str, str], line: int, has_decimal_commas: bool) -> dict[str, Any]:
    """Settings as JSON has them, of the cells of a row."""
    known = {each.name: each for each in declared_options(STORED[kind].settings)}
    values: dict[str, Any] = {}
    for name, cell in cells.items():
        if name not in known:
            near = did_you_mean(name, known)
            raise SchemaError(f"column {name} of line {line}{near} is none of {', '.join(known)}")
        if has_decimal_commas and known[name].wanted is float:
            cell = _with_point(cell)
        try:
            value = _flag(cell) if known[name].wanted is bool else value_from_text(known[name], cell)
        except ValueError as error:
            raise SchemaError(f"{name} of line {line}: {error}") from error
        values[name] = list(value) if isinstance(value, tuple) else value
    return values


def _with_point(number: str) -> str:
    return number.replace(",", ".")


def _flag(cell: str) -> bool:
    if cell.lower() not in FLAGS:
        raise ValueError(f"{cell!r} is neither true nor false")
    return FLAGS[cell.lower()]
