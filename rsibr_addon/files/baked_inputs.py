"""Files of baked inputs: what Cycles made of an object's materials where no image says it.

One OpenEXR file holds the pictures of all slots of an object. A part's name is the number of the slot and the
fields of `PrincipledInputs` that it holds: ``0 base_color``, ``1 metallic roughness``. The pictures lie on
a UV map of the object, or on an unwrapping of their own, which the part ``corners`` then holds.
"""

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import TypedDict

import numpy as np

from ..core.conventions import Array
from ..core.errors import InputFileError, SchemaError
from ..core.materials.packing import Picture
from ..core.materials.principled import PrincipledInputs, Texture
from ..core.schema import decode, loads
from .atomic import written_aside
from .exr import read_attributes, read_parts, write_parts
from .exr_part import Part

ATTRIBUTE = "rsibrInputs"
"""Name of the first part's attribute that describes the file, as JSON."""

CORNERS = "corners"
"""Part with the unwrapping."""

ROW = 4096
"""Corners in a row of that part."""

INPUTS = frozenset(field.name for field in fields(PrincipledInputs))
"""What a picture may hold."""


class _Description(TypedDict):
    uv_map: str
    corners: int
    remarks: list[str]


@dataclass(frozen=True, eq=False)
class BakedInputs:
    """Pictures of baked inputs.

    Attributes
    ----------
    pictures : mapping of (int, Picture) to ndarray, shape (height, width, 3), float32
        Slot and what a picture holds -> texels as Cycles has them, row 0 at the bottom.
    uv_map : str
        UV map on which they lie; empty where they lie on `corners`.
    corners : ndarray, shape (C, 2), float32, optional
        Place of every corner of the object's evaluated mesh on the pictures.
    remarks : tuple of str
        What an artist should know of them, in sentences.
    """

    pictures: Mapping[tuple[int, Picture], Array]
    uv_map: str = ""
    corners: Array | None = None
    remarks: tuple[str, ...] = ()


def part_name(slot: int, picture: Picture) -> str:
    """The name of a picture in its file, and of its `Texture.image`."""
    return " ".join((str(slot), *picture))


def unwrapping_name(path: Path) -> str:
    """The `Texture.uv_map` of a file with an unwrapping of its own; Blender takes it as a UV map's name."""
    return f"rsibr {hashlib.sha256(path.name.encode()).hexdigest()[:16]}"


def textures_of(path: Path, baked: BakedInputs) -> dict[int, list[tuple[Picture, Texture]]]:
    """Baked inputs as textures of materials.

    Returns
    -------
    dict of int to list of (Picture, Texture)
        Slot -> what its pictures hold, for `core.materials.packing.with_pictures`.
    """
    uv_map = baked.uv_map if baked.corners is None else unwrapping_name(path)
    textures: dict[int, list[tuple[Picture, Texture]]] = {}
    for slot, picture in baked.pictures:
        name = part_name(slot, picture)
        texture = Texture(name, bake=str(path), uv_map=uv_map, extension="EXTEND")
        textures.setdefault(slot, []).append((picture, texture))
    return textures


def write_baked_inputs(path: Path, baked: BakedInputs, force: bool = False) -> None:
    """Write a file; equal inputs give equal bytes.

    Raises
    ------
    OutputFileError
        It exists and `force` is not set, or it cannot be written.
    """
    parts = [Part(part_name(*key), {"RGB": texels}) for key, texels in baked.pictures.items()]
    count = 0
    if baked.corners is not None:
        count = len(baked.corners)
        padded = np.zeros((-(-count // ROW) * ROW, 2), np.float32)
        padded[:count] = baked.corners
        u, v = padded.T.reshape(2, -1, ROW)
        parts.append(Part(CORNERS, {"U": u, "V": v}))
    description: _Description = {
        "uv_map": baked.uv_map,
        "corners": count,
        "remarks": list(baked.remarks),
    }
    first = Part(parts[0].name, parts[0].channels, {ATTRIBUTE: json.dumps(description)})
    with written_aside(path, force) as aside:
        write_parts(aside, [first, *parts[1:]])


def read_baked_inputs(path: Path) -> BakedInputs:
    """Read a file.

    Raises
    ------
    InputFileError
        It is missing, damaged, or holds something else.
    RangeError
        It is too large for this machine's memory.
    """
    parts = {part.name: part for part in read_parts(path)}
    described = _description(path, next(iter(parts.values())).attributes)
    corners, count = None, described["corners"]
    if count:
        found = parts.pop(CORNERS, None)
        if found is None or found.channels.keys() != set("UV") or not 0 < count <= found.channels["U"].size:
            raise _unknown(path)
        corners = np.stack([found.channels[axis].ravel()[:count] for axis in "UV"], axis=-1)
    pictures = {}
    for name, part in parts.items():
        slot, _, held = name.partition(" ")
        picture = tuple(held.split())
        is_known = slot.isdecimal() and INPUTS.issuperset(picture) and 1 <= len(picture) <= len("RGB")
        if not is_known or part.channels.keys() != set("RGB"):
            raise _unknown(path)
        texels = part.side_by_side("RGB")
        pictures[int(slot), picture] = texels.astype(np.float32, copy=False)
    return BakedInputs(pictures, described["uv_map"], corners, tuple(described["remarks"]))


def is_whole(path: Path) -> bool:
    """Whether a file is there and holds baked inputs; files appear whole or not at all."""
    try:
        _description(path, read_attributes(path)[0])
    except InputFileError:
        return False
    return True


def _description(path: Path, attributes: Mapping[str, object]) -> _Description:
    try:
        text = attributes.get(ATTRIBUTE)
        return decode(_Description, loads(text if isinstance(text, str) else ""))
    except SchemaError as error:
        raise _unknown(path) from error


def _unknown(path: Path) -> InputFileError:
    return InputFileError(f"{path} holds no baked inputs of materials: remove it, and bake them again.")
