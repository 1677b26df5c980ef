"""Map sets as textures, as graphics interfaces take them, whatever the format of their file."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any

import numpy as np

from ..core.conventions import WORLD_AXES, Array
from ..core.half_floats import half_holds
from ..core.maps.representation import representation
from ..core.resample import bordered
from .kinds.sheets import sheets_from_strip
from .map_set_data import ENVIRONMENT, MapSet

OCTAHEDRAL = representation("octahedral")


class Up(StrEnum):
    """The axis of textures that points up."""

    Z = "z"
    Y = "y"


@dataclass(frozen=True)
class Texture:
    """A cube or an array of layers, with its mips.

    Attributes
    ----------
    levels : tuple of ndarray, shape (layers, height, width, 3 or 4)
        Mips from the largest, each half as wide and high as the one before. Row 0 is that of v = 0.
    is_cube : bool
        Whether the six layers are the faces of a cube, as in `core.maps.cube_map`.
    name : str
        What distinguishes it from others of its map set.
    note : mapping
        What its shaders have to know, as JSON values.
    """

    levels: tuple[Array, ...]
    is_cube: bool = False
    name: str = ""
    note: Mapping[str, Any] = field(default_factory=dict)

    @property
    def is_half(self) -> bool:
        """Whether 16-bit floats can hold every value: see `half_holds`."""
        return half_holds(self.levels)


def arrays(map_set: MapSet, numbers: Sequence[str]) -> list[Texture]:
    """A texture for each size of maps, a layer for each of their sheets; their names are their maps' roles.

    Parameters
    ----------
    map_set : MapSet
    numbers : sequence of str
        Roles of parts that are tables of a few numbers: notes hold them, row by row from v = 0.

    Returns
    -------
    list of Texture
        With Z up; without the environment. Octahedral layers are `bordered`: edges continue at edges, which
        no graphics interface knows.
    """
    header = map_set.header
    border = int(header["layout"] == OCTAHEDRAL.name)
    parts = [part for part in header["parts"] if part["role"] not in (ENVIRONMENT, *numbers)]
    sheets = {part["name"]: _sheets(map_set.maps[part["name"]], header["layout"]) for part in parts}
    tables = {
        part["role"]: {"part": part, "rows": map_set.maps[part["name"]].tolist()}
        for part in header["parts"]
        if part["role"] in numbers
    }
    alike: dict[tuple[int, ...], list[dict[str, Any]]] = {}
    for part in parts:
        alike.setdefault(sheets[part["name"]].shape, []).append(part)
    roles = {size: "-".join(dict.fromkeys(part["role"] for part in those)) for size, those in alike.items()}
    textures = []
    for size, those in alike.items():
        layers = [{**part, "sheet": sheet} for part in those for sheet in range(size[0])]
        width = size[2] - 2 * border
        is_only = [*roles.values()].count(roles[size]) == 1
        textures.append(
            Texture(
                (np.concatenate([sheets[part["name"]] for part in those]),),
                name=roles[size] if is_only else f"{roles[size]}-{width}",
                note={"axes": WORLD_AXES, "border": border, "layers": layers, "numbers": tables},
            )
        )
    return textures


def _sheets(strip: Array, layout: str) -> Array:
    count = len(representation(layout).sheets)
    height, width = strip.shape[:2]
    sheets = sheets_from_strip(strip, (count, height // count, width))
    return bordered(sheets, OCTAHEDRAL) if layout == OCTAHEDRAL.name else sheets
