"""Exposure times as people write them: 1/125, 0.5, 8."""

import math
import re
from pathlib import Path

from ..core.errors import InputFileError
from ..core.options import number_from_text
from .reading import opened, text_of

LARGEST = 1 << 20
"""Largest list of times in bytes."""


def exposure_time(text: str) -> float:
    """The time that a text states.

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
    time = number_from_text(text)
    if not 0.0 < time < math.inf:
        raise ValueError(f"'{text}' is no exposure time")
    return time


def read_times(path: str | Path) -> tuple[float, ...]:
    """Read a list of exposure times.

    Parameters
    ----------
    path : str or Path
        Text: the times, one for each photograph in order, between them spaces, commas, semicolons or line
        breaks. They may be quoted and have an s for seconds; in a line, a comment follows # or //.

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
        data = stream.read(LARGEST)
    lines = re.sub(r"(#|//).*", "", text_of(data, "replace").replace("\r", "\n"))
    words = re.split(r"[\s,;\"']+", re.sub(r"\s*/\s*", "/", re.sub(r"(?<=\d)\s*s\b", "", lines)))
    try:
        return tuple(exposure_time(word[:40]) for word in words if word)
    except ValueError as error:
        raise InputFileError(f"{path} is no list of exposure times ({error}): write 1/125 or 0.5.") from error
