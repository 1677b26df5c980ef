"""Names of outputs, and paths of results that go beside a map set under its name."""

import re
from pathlib import Path

HASH_LETTERS = 10
"""Length of a hash in the name of a file or folder; it tells a million apart."""


def portable_name(text: str) -> str:
    """A text, of the signs that every system and every farm takes in names; empty where it has none."""
    return re.sub(r"[^\w.]+", "-", text).strip("-.")


def report_beside(map_set: Path) -> Path:
    """The default path of a map set's report: NAME.html beside NAME.rsibr.exr."""
    return map_set.with_name(f"{bare_name(map_set)}.html")


def comparison_beside(map_set: Path) -> Path:
    """The folder of the panel's comparison of a map set: NAME-compared beside NAME.rsibr.exr."""
    return map_set.with_name(f"{bare_name(map_set)}-compared")


def comparison_page(map_set: Path) -> Path:
    """The page of that comparison."""
    return comparison_beside(map_set) / "index.html"


def bare_name(map_set: Path) -> str:
    """The name of a map set's file without .rsibr.exr."""
    return map_set.name.removesuffix(".exr").removesuffix(".rsibr")
