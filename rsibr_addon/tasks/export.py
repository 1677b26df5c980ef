"""Map sets as textures for engines: KTX 2.0 files, with what their shaders have to know."""

import json
from enum import StrEnum
from pathlib import Path
from typing import Any

import numpy as np

from ..core.conventions import WORLD_AXES, Array
from ..core.errors import OutputFileError, RangeError
from ..core.kinds.mip_chain.chain import MipChain
from ..core.maps.representation import representation
from ..core.progress import Progress, Steps
from ..files.atomic import check_target
from ..files.kinds import mip_chain
from ..files.kinds.sheets import sheets_from_strip
from ..files.ktx2 import Texture, write_ktx2
from ..files.map_set import read_map_set
from ..files.map_set_data import MapSet
from ..files.map_set_header import ENVIRONMENT
from ..files.outputs import together

NUMBERS = ("albedo", "weights", mip_chain.HARMONICS)
"""Roles of parts that are tables of a few numbers: a note holds them, row by row from v = 0."""


class Up(StrEnum):
    """Which axis of the exported textures points up."""

    Z = "z"
    Y = "y"


Y_UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
"""Directions with Y up, as glTF has them, from Blender's."""

Y_UP_AXES = "right-handed, Y up: (x, y, z) here is (x, -z, y) of Blender's world"


def export(map_set: Path, output: Path, up: Up = Up.Z, force: bool = False) -> Steps[list[Path]]:
    """Write a map set's maps as textures.

    Parameters
    ----------
    map_set : Path
    output : Path
        NAME.ktx2; where maps are of several sizes, NAME-ROLE.ktx2 for each.
    up : Up
        Y for mip chains alone, whose texels it leaves as they are; others are looked up by directions
        with Z up.
    force : bool
        Whether existing files are replaced.

    Yields
    ------
    Progress

    Returns
    -------
    list of Path
        The files that were written.

    Raises
    ------
    MapSetError
        See `files.map_set.read_map_set`.
    RangeError
        `up` is Y, and the map set no mip chain.
    OutputFileError
        The name does not end in .ktx2, or a file cannot be written or exists.

    Notes
    -----
    docs/export.md says what the files hold.
    """
    if output.suffix.lower() != ".ktx2":
        raise OutputFileError(f"{output} would not be known for a texture: give a name that ends in .ktx2.")
    yield Progress(0, 2, f"reading {map_set.name}")
    held = read_map_set(map_set)
    if held.kind == mip_chain.KIND:
        textures = {output: _cube(mip_chain.from_map_set(map_set, held), up)}
    elif up is Up.Y:
        raise RangeError(f"{map_set} is no mip chain: export it with Z up, and look it up by (x, -z, y).")
    else:
        textures = _arrays(held, output)
    for path in textures:
        check_target(path, force)
    yield Progress(1, 2, f"writing {output.name}")
    with together():
        for path, (texture, note) in textures.items():
            text = json.dumps({**note, **_common(held)}, allow_nan=False)
            write_ktx2(path, texture, {"KTXwriter": held.header["software"], "rsibr": text}, force)
    return list(textures)


def _cube(chain: MipChain, up: Up) -> tuple[Texture, dict[str, Any]]:
    turned = chain.turned(Y_UP) if up is Up.Y else chain
    note = {
        "axes": Y_UP_AXES if up is Up.Y else WORLD_AXES,
        "roughness": chain.roughness,
        "numbers": {mip_chain.HARMONICS: {"rows": [turned.harmonics.tolist()]}},
    }
    return Texture(turned.mips, is_cube=True), note


def _arrays(held: MapSet, output: Path) -> dict[Path, tuple[Texture, dict[str, Any]]]:
    """A texture for each size of maps, a layer for each of their sheets."""
    parts = [part for part in held.header["parts"] if part["role"] not in (ENVIRONMENT, *NUMBERS)]
    sheets = {part["name"]: _sheets(held.maps[part["name"]], held.header["layout"]) for part in parts}
    numbers = {
        part["role"]: {**part, "rows": held.maps[part["name"]].tolist()}
        for part in held.header["parts"]
        if part["role"] in NUMBERS
    }
    textures = {}
    for size in dict.fromkeys(each.shape for each in sheets.values()):
        alike = [part for part in parts if sheets[part["name"]].shape == size]
        layers = [{**part, "sheet": sheet} for part in alike for sheet in range(size[0])]
        note = {"axes": WORLD_AXES, "layers": layers, "numbers": numbers}
        texture = Texture((np.concatenate([sheets[part["name"]] for part in alike]),))
        roles = "-".join(dict.fromkeys(part["role"] for part in alike))
        path = output if len(alike) == len(parts) else output.with_stem(f"{output.stem}-{roles}")
        textures[path] = texture, note
    return textures


def _sheets(strip: Array, layout: str) -> Array:
    count = len(representation(layout).sheets)
    height, width = strip.shape[:2]
    return sheets_from_strip(strip, (count, height // count, width))


def _common(held: MapSet) -> dict[str, Any]:
    kept = {field: held.header[field] for field in ("layout", "material", "error_bound", "settings")}
    return {"kind": held.kind, "environment": held.header["environment"]["name"], **kept}
