"""A map set in memory, between its file and its kind."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from ..core.conventions import Array

ENVIRONMENT = "environment"
"""The role of the part that holds the environment, and its name."""


@dataclass(frozen=True)
class MapSet:
    """Maps that belong together, and their description.

    Attributes
    ----------
    kind : str
        One of `kinds.registry.STORED`; or "environment", of a picture.
    maps : dict of str to ndarray, shape (height, width, 3), float32
        Radiance by part name, finite, row 0 at the bottom.
    header : dict
        The description of docs/map-set-format.md, without what follows from the rest: format, kind, and each
        part's size and sha256. JSON values only; its "parts" are named and ordered as `maps`.
    """

    kind: str
    maps: dict[str, Array]
    header: dict[str, Any]


@dataclass(frozen=True)
class MapsInTurn:
    """A map set whose maps are made while it is written, so that not all are in memory at once.

    Attributes
    ----------
    kind, header
        See `MapSet`.
    shapes : dict of str to (int, int)
        Height and width by part name.
    maps : iterable of ndarray, shape (height, width, 3)
        In the order of `shapes`.
    """

    kind: str
    shapes: dict[str, tuple[int, int]]
    maps: Iterable[Array]
    header: dict[str, Any]
