"""Numbers of things, and lists of names, in sentences."""

from collections.abc import Sequence

NAMES_SHOWN = 8
"""Names that a sentence lists; it counts the others."""


def counted(number: int, thing: str) -> str:
    """A number of things, in words."""
    return f"{number} {thing}" if number == 1 else f"{number} {thing}s"


def in_short(names: Sequence[str]) -> str:
    """Names with commas between them, and how many more there are after `NAMES_SHOWN`."""
    more = len(names) - NAMES_SHOWN
    return ", ".join(names[:NAMES_SHOWN]) + (f" and {more} more" if more > 0 else "")
