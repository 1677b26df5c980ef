"""Exposure times as people write them: 1/125, 0.5, 8."""

import math
from pathlib import Path

from ..core.errors import InputFileError
from .reading import opened


def exposure_time(text: str) -> float:
    """The time that a text means.

    Parameters
    ----------
    text : str
        A number or a fraction: 0.5, 1/125.

    Returns
    -------
    float
        [s], above 0.

    Raises
    ------
    ValueError
        It is neither.
    """
    numerator, slash, denominator = text.partition("/")
    parts = float(numerator), float(denominator) if slash else 1.0
    if not (parts[1] > 0.0 and math.isfinite(parts[0] / parts[1]) and parts[0] > 0.0):
        raise ValueError(f"'{text}' is no exposure time")
    return parts[0] / parts[1]


def read_times(path: str | Path) -> tuple[float, ...]:
    """Read a list of exposure times.

    Parameters
    ----------
    path : str or Path
        Text: the times, one for each photograph in order, between them spaces or line breaks.

    Returns
    -------
    tuple of float
        [s].

    Raises
    ------
    InputFileError
        The file is missing or unreadable, or holds something else.
    """
    with opened(path) as stream:
        words = stream.read().decode("utf-8", errors="replace").split()
    try:
        return tuple(exposure_time(word) for word in words)
    except ValueError as error:
        raise InputFileError(f"{path} is no list of exposure times ({error}): write 1/125 or 0.5.") from error
