"""What looks of several kinds demand of their values."""

from collections.abc import Sequence

from ..errors import RangeError


def check_shares(name: str, values: Sequence[float]) -> None:
    """Refuse what is no share of the light.

    Parameters
    ----------
    name : str
        Of the look's field, for the message.
    values : sequence of float

    Raises
    ------
    RangeError
        One of them is below 0 or above 1.
    """
    if not all(0.0 <= value <= 1.0 for value in values):
        raise RangeError(f"{name} {values} is out of range: choose numbers from 0 to 1.")
