"""Small pictures of all maps of a map set."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ...core.conventions import Array
from ...core.light.transfer_curve import srgb_from_linear
from ...core.pictures.thumbnail import thumbnail
from ...files.kinds.registry import STORED
from ...files.map_set import read_map_set
from ...files.map_set_data import ENVIRONMENT

SIZE = 128
"""Largest width and height in pixels: what Blender shows of a picture in a panel."""

BRIGHTEST = 0.05
"""Share of a map's pixels that may be shown as white."""


@dataclass(frozen=True, eq=False)
class MapPicture:
    """A map to be looked at.

    Attributes
    ----------
    name : str
        Name of its part.
    title : str
        For people.
    pixels : ndarray, shape (height, width, 3), float32
        sRGB in [0, 1], row 0 at the bottom: of radiance up to 1 or, in a brighter map, up to what
        `BRIGHTEST` of its pixels reach.
    """

    name: str
    title: str
    pixels: Array


def map_set_pictures(path: Path) -> list[MapPicture]:
    """Read a map set and make its maps small; knows nothing of Blender, so it may run in any thread.

    Returns
    -------
    list of MapPicture
        In the file's order, but black maps behind others, so that the first has something to show, and tables
        of numbers and the environment last.

    Raises
    ------
    MapSetError
        See `files.map_set.read_map_set`.
    """
    held = read_map_set(path)
    stored = STORED[held.kind]
    behind = (*stored.numbers, ENVIRONMENT)

    def rank(part: dict[str, Any]) -> tuple[bool, bool]:
        return part["role"] in behind, not held.maps[part["name"]].any()

    parts = sorted(held.header["parts"], key=rank)
    return [
        MapPicture(part["name"], stored.part_title(part), _pixels(held.maps[part["name"]])) for part in parts
    ]


def _pixels(radiance: Array) -> Array:
    small = thumbnail(radiance, SIZE)
    white = max(1.0, float(np.quantile(small.max(axis=-1), 1.0 - BRIGHTEST)))
    return srgb_from_linear(small / white).astype(np.float32)
