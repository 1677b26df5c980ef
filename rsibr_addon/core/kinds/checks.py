"""Checks that the looks of several kinds share."""

from collections.abc import Sequence
from enum import StrEnum

from ..errors import RangeError


def member[Choice: StrEnum](choices: type[Choice], value: str, name: str) -> Choice:
    """The choice with a given name; a file of a newer version may have an unknown one.

    Parameters
    ----------
    choices : type
    value : str
    name : str
        Name of the look's field, for the message.

    Raises
    ------
    RangeError
        There is no such choice.
    """
    try:
        return choices(value)
    except ValueError as error:
        raise RangeError(
            f"There is no {name} {value!r} in this version: choose from {', '.join(choices)}."
        ) from error


def check_shares(name: str, values: Sequence[float]) -> None:
    """Refuse numbers that are not shares of the light.

    Parameters
    ----------
    name : str
        Name of the look's field, for the message.
    values : sequence of float

    Raises
    ------
    RangeError
        One of them is below 0 or above 1.
    """
    if not all(0.0 <= value <= 1.0 for value in values):
        raise RangeError(f"{name} {values} is out of range: choose numbers from 0 to 1.")
