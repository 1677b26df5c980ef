"""What is made of a map set goes beside it, under its name."""

from pathlib import Path


def page_beside(map_set: Path) -> Path:
    """Where the page of a map set goes unless one says otherwise: NAME.html beside NAME.rsibr.exr."""
    return map_set.with_name(f"{_name(map_set)}.html")


def comparison_beside(map_set: Path) -> Path:
    """The folder where the panel's comparison of a map set goes: NAME-compared beside NAME.rsibr.exr."""
    return map_set.with_name(f"{_name(map_set)}-compared")


def _name(map_set: Path) -> str:
    return map_set.name.removesuffix(".exr").removesuffix(".rsibr")
