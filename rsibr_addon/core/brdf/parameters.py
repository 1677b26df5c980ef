"""Parameters that know their ranges: a dataclass's annotations are checked when it is made."""

from dataclasses import dataclass
from functools import cache
from typing import Annotated, Any, get_args, get_origin, get_type_hints

import numpy as np

from ..errors import RangeError

Color = float | tuple[float, float, float]
"""A parameter for linear Rec. 709 red, green and blue; a single number is a grey, and kept as three."""


@dataclass(frozen=True)
class Range:
    """The range of a number: from `low`, excluded when `low_open`, to `high`."""

    low: float
    high: float = np.inf
    low_open: bool = False

    def __contains__(self, number: float) -> bool:
        return bool(self.low <= number <= self.high and not (self.low_open and number == self.low))

    def __str__(self) -> str:
        if not self.low_open and np.isfinite(self.high):
            return f"from {self.low:g} to {self.high:g}"
        start = f"greater than {self.low:g}" if self.low_open else f"at least {self.low:g}"
        return f"{start} and at most {self.high:g}" if np.isfinite(self.high) else start


@cache
def parameter_ranges(owner: type) -> dict[str, tuple[Range, bool]]:
    """The numbers that a dataclass takes.

    Parameters
    ----------
    owner : type
        A dataclass; only its fields ``Annotated[float, Range(...)]`` and ``Annotated[Color, Range(...)]`` are
        returned.

    Returns
    -------
    dict
        Field -> its range, and whether it is a colour.
    """
    hints = get_type_hints(owner, include_extras=True)
    annotated = {name: get_args(hint) for name, hint in hints.items() if get_origin(hint) is Annotated}
    return {name: (limits, kind is Color) for name, (kind, limits) in annotated.items()}


def check_numbers(name: str, given: Any, limits: Range) -> list[float]:
    """The numbers of a parameter, or the one that it has.

    Raises
    ------
    RangeError
        One is NaN or lies outside the range; the sentence names the parameter and the range.
    """
    numbers = [float(number) for number in np.ravel(given)]
    for number in numbers:
        if number not in limits:
            raise RangeError(f"{name} is {number:g}, but it must be {limits}.")
    return numbers


class Checked:
    """Base of dataclasses whose annotated numbers are checked, and kept as float or three floats.

    Raises
    ------
    RangeError
        See `check_numbers`.
    """

    def __post_init__(self) -> None:
        owner: type = type(self)
        for name, (limits, is_color) in parameter_ranges(owner).items():
            given: Any = getattr(self, name)
            numbers = check_numbers(name, given, limits)
            value = tuple(np.broadcast_to(numbers, 3).tolist()) if is_color else float(given)
            object.__setattr__(self, name, value)
