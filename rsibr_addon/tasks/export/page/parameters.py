"""A look's options as sliders: what each sets of the block of numbers that a program draws from.

A page knows no kind and no option. It is told how the block depends on each option, which is found by trying.
"""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from ....core.conventions import Array
from ....core.errors import RangeError
from ....core.options import Declared, declared_options
from ....device.buffers import block_rows
from ....device.drawing import Inputs, WithInputs

SAMPLES = 201
"""Of a number that the block does not follow in proportion."""

ENDS = np.array([0.0, 1.0])


def parameters(drawable: WithInputs, look: Any) -> list[dict[str, Any]]:
    """What can be chosen of a look on a page.

    Parameters
    ----------
    drawable : WithInputs
    look : Options
        What the page shows at first.

    Returns
    -------
    list of dict
        Of each option that changes numbers of the block alone: "name", "label", "help", "unit", "advanced";
        "form", which is "slider", "colour", "check" or "choice"; "start", its number, its three, or the place
        of its choice; "choices", their labels; and "sets", for each of its components "at", numbers that
        ascend, "entries", places in the block, and "values", the entries' values at each of these numbers.
        Between them the block is linear. No entry is set by two options: the later one has
        it, unless that is advanced and the other is not.
    """
    found: list[dict[str, Any]] = []
    for declared in declared_options(type(look)):
        sets = [each for each in _sets(drawable, look, declared) if each["entries"]]
        if not sets:
            continue
        told = declared.option
        rivals = [each for each in found if _entries(each["sets"]) & _entries(sets)]
        if told.advanced and not all(each["advanced"] for each in rivals):
            continue
        found = [each for each in found if each not in rivals]
        found.append(
            {
                "name": declared.name,
                "label": told.label,
                "help": told.help,
                "unit": told.unit,
                "advanced": told.advanced,
                "form": _form(declared),
                "choices": [choice.label for choice in told.choices.values()],
                "start": _start(drawable, look, declared, sets),
                "sets": sets,
            }
        )
    return found


def _entries(sets: list[dict[str, Any]]) -> set[int]:
    return {entry for each in sets for entry in each["entries"]}


def block_of(inputs: Inputs) -> Array:
    """The numbers of a block, shape (4 * rows,)."""
    return block_rows(*inputs.fields).reshape(-1)


def _form(declared: Declared) -> str:
    if declared.wanted is tuple:
        return "colour"
    if declared.option.choices:
        return "choice"
    return "check" if declared.wanted is bool else "slider"


def _sets(drawable: WithInputs, look: Any, declared: Declared) -> Iterator[dict[str, Any]]:
    """What each component of an option sets; nothing where that cannot be told by numbers."""
    if declared.option.choices and declared.wanted is not tuple:
        values = list(declared.option.choices)
        places = np.linspace(0.0, len(values) - 1.0, len(values))
        yield _tried(drawable, look, [{declared.name: value} for value in values], places)
    elif declared.wanted is bool:
        yield _tried(drawable, look, [{declared.name: value} for value in (False, True)], ENDS)
    elif declared.wanted is float and np.all(np.isfinite(_range(declared))):
        numbers = np.linspace(*_range(declared), SAMPLES)
        yield _tried(drawable, look, [{declared.name: number} for number in numbers.tolist()], numbers)
    elif declared.option.subtype == "COLOR":
        colour = getattr(look, declared.name)
        for channel in range(3):
            ends = [{declared.name: (*colour[:channel], end, *colour[channel + 1 :])} for end in (0.0, 1.0)]
            yield _tried(drawable, look, ends, ENDS)


def _range(declared: Declared) -> tuple[float, float]:
    told = declared.option
    return (
        told.least if told.soft_least is None else told.soft_least,
        told.most if told.soft_most is None else told.soft_most,
    )


def _tried(drawable: WithInputs, look: Any, changes: list[dict[str, Any]], at: Array) -> dict[str, Any]:
    """The block of a look with each change; no entries where one cannot be, or wants other textures."""
    none: dict[str, Any] = {"at": [], "entries": [], "values": []}
    textures = drawable.inputs(look).textures
    blocks = []
    for change in changes:
        try:
            inputs = drawable.inputs(replace(look, **change))
        except RangeError:
            return none
        if inputs.textures != textures:
            return none
        blocks.append(block_of(inputs).astype(np.float64))
    tried = np.array(blocks)
    changing = np.flatnonzero(np.any(tried != tried[0], axis=0))
    used, values = _without_flat_end(at, tried[:, changing])
    if _is_straight(used, values):
        used, values = used[[0, -1]], values[[0, -1]]
    return {"at": used.tolist(), "entries": changing.tolist(), "values": values.tolist()}


def _without_flat_end(numbers: Array, values: Array) -> tuple[Array, Array]:
    """Without the numbers from which on nothing changes."""
    moving = np.flatnonzero(np.any(values != values[-1], axis=1))
    end = moving[-1] + 2 if len(moving) else 0
    return numbers[:end], values[:end]


def _is_straight(numbers: Array, values: Array) -> bool:
    if not len(numbers):
        return False
    share = (numbers - numbers[0])[:, None] / (numbers[-1] - numbers[0])
    straight = values[0] + share * (values[-1] - values[0])
    return bool(np.allclose(values, straight, rtol=1e-6, atol=1e-6 * np.abs(values).max()))


def _start(
    drawable: WithInputs, look: Any, declared: Declared, sets: list[dict[str, Any]]
) -> float | list[float]:
    """What an option is at first; of one that is None, the number that draws the same."""
    value = getattr(look, declared.name)
    if declared.option.choices:
        return list(declared.option.choices).index(value)
    if isinstance(value, tuple):
        return list(value)
    if value is not None:
        return float(value)
    now = block_of(drawable.inputs(look))[sets[0]["entries"]]
    nearest = np.abs(np.array(sets[0]["values"]) - now).sum(axis=1).argmin()
    return float(sets[0]["at"][nearest])
