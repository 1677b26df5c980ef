"""Map sets on disk: one multi-part OpenEXR file with its description inside (docs/map-set-format.md)."""

import contextlib
import hashlib
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from ..core.conventions import Array
from ..core.errors import (
    InputFileError,
    MapSetError,
    MemoryShortageError,
    RangeError,
    SchemaError,
    ShapeError,
)
from ..core.half_floats import half_holds, half_states
from ..core.schema import loads
from ..core.threads import in_order
from ..core.warned import warn
from . import radiance_hdr
from .atomic import check_target, written_aside
from .exr import MAGIC, OpenExr
from .exr_in_turn import PartsInTurn
from .exr_part import Part
from .kinds.registry import STORED
from .map_set_check import check_header
from .map_set_data import MapSet, MapsInTurn
from .map_set_header import FORMAT
from .map_set_mark import ATTRIBUTE, description
from .photographs import PHOTOGRAPHS
from .reading import opened

COVER = "cover"
"""Name of the first part: black, as wide and high as the largest map, and not listed.

Some readers, Blender's image loader among them, take the first part's size for that of all parts, and would
write beyond their memory where another is larger.
"""

SMALLEST_TEXEL = 6.0 / 1032.0
"""Bytes of a black texel of half floats, as deflate packs it at best."""

PICTURES = (radiance_hdr.MAGIC, *PHOTOGRAPHS)
"""First bytes of pictures that people take for map sets."""

A_PICTURE = "is a picture, not a map set: make one with `rsibr bake`."
NOTHING_KNOWN = "is not a map set: give one, or make one with `rsibr bake`."

DERIVED = ("size", "sha256")
"""Fields of a part that follow from its pixels."""


def check_map_set_target(path: str | Path, force: bool = False) -> None:
    """Refuse a name that `write_map_set` would refuse, unless it may be replaced, before long work begins.

    Raises
    ------
    OutputFileError
        The name does not end in .exr; or see `check_target`.
    """
    check_target(path, force, (".rsibr.exr", ".exr"))


def write_map_set(
    path: str | Path, map_set: MapSet | MapsInTurn, force: bool = False, half: bool = False
) -> None:
    """Write a map set; equal sets give equal bytes.

    Parameters
    ----------
    path : str or Path
        NAME.rsibr.exr, or NAME.exr.
    map_set : MapSet or MapsInTurn
    force : bool
        Whether an existing file is replaced.
    half : bool
        Store 16-bit floats, in half the space, for each map that they can hold: see `half_holds`. All other
        maps are read back bit by bit, as without it; 16-bit floats are stored of them where these suffice.

    Raises
    ------
    OutputFileError
        See `check_map_set_target` and `written_aside`; where possible, before anything is computed.
    MapSetError
        The header is not what the format demands.
    ShapeError
        The maps are not those that the header lists, or one does not have the shape (height, width, 3).
    RangeError
        A map holds NaN or infinite values.

    Warns
    -----
    RsibrWarning
        Maps are too bright or too dark for half floats; says how many.
    """
    check_map_set_target(path, force)
    if isinstance(map_set, MapSet):
        for name, pixels in map_set.maps.items():
            _check_shape(name, pixels)
        shapes = {name: pixels.shape[:2] for name, pixels in map_set.maps.items()}
        map_set = MapsInTurn(map_set.kind, shapes, map_set.maps.values(), map_set.header)
    listed = [part.get("name") for part in map_set.header.get("parts", [])]
    if listed != list(map_set.shapes):
        raise ShapeError(f"{path} would hold the maps {list(map_set.shapes)}, but its header lists {listed}.")
    header = {"format": FORMAT, "kind": map_set.kind, **map_set.header}
    # Unknown checksums have the same length as known ones
    header["parts"] = [
        {**part, "size": [*map_set.shapes[part["name"]][::-1]], "sha256": "0" * 64}
        for part in header["parts"]
    ]
    check_header(header, str(path))
    largest = np.max(list(map_set.shapes.values()), axis=0)
    whole = 0
    with written_aside(path, force) as aside, aside.open("wb") as stream:
        text = json.dumps(header, allow_nan=False)
        parts = PartsInTurn(stream, {COVER: tuple(largest), **map_set.shapes}, ATTRIBUTE, text)
        parts.add_black(COVER)
        for part, pixels in zip(header["parts"], map_set.maps, strict=True):
            stored = _stored(part["name"], pixels, half)
            whole += stored.dtype.itemsize > 2
            part |= _derived(stored)
            parts.add(part["name"], stored)
        parts.finish(json.dumps(header, allow_nan=False))
    if half and whole:
        warn(
            f"{whole} of the {len(listed)} maps of {path} are too bright or too dark for 16-bit floats, and "
            f"are stored with 32 bits."
        )


def read_map_set(path: str | Path, kind: str | None = None) -> MapSet:
    """Read a map set, checking everything.

    Parameters
    ----------
    path : str or Path
    kind : str, optional
        The kind that is needed.

    Returns
    -------
    MapSet
        Maps are float32 also where the file holds half floats.

    Raises
    ------
    MapSetError
        As `read_map_set_header`; or the set is of another kind, too large for this machine's memory, or
        pixels are missing, differ from what was written, or are not finite.
    """
    with _opened_exr(path) as file:
        header = _checked_header(path, file)
        if kind not in (None, header["kind"]):
            raise MapSetError(
                f"{path} holds {header['kind']}, but {kind} are needed here: give another map set."
            )
        found = {part.name: part for part in file.parts()}
    # Most of the time goes into checksums and copies, during which Python lets other threads run
    checked = in_order(lambda part: _checked_pixels(path, part, found[part["name"]]), header["parts"])
    maps = {part["name"]: pixels for part, pixels in zip(header["parts"], checked, strict=True)}
    kept = {field: value for field, value in header.items() if field not in ("format", "kind")}
    kept["parts"] = [
        {field: value for field, value in part.items() if field not in DERIVED} for part in header["parts"]
    ]
    return MapSet(header["kind"], maps, kept)


def read_map_set_header(path: str | Path) -> dict[str, Any]:
    """Read a map set's description, without its pixels.

    Returns
    -------
    dict
        The whole description of docs/map-set-format.md.

    Raises
    ------
    MapSetError
        The file is missing, unreadable, not OpenEXR, a picture without a description, of a newer
        version or an unknown kind; the description is damaged, incomplete, or lists other parts or
        sizes than the file holds.
    """
    with _opened_exr(path) as file:
        return _checked_header(path, file)


def is_whole_map_set(path: str | Path) -> bool:
    """Whether a file is there, and a map set that is whole and of maps that its kind takes.

    What there is too little memory to read counts as whole: a bake takes less than to read all of it at once.
    """
    try:
        held = read_map_set(path)
        STORED[held.kind].from_map_set(Path(path), held)
    except MapSetError as error:
        return isinstance(error.__cause__, MemoryShortageError)
    return True


def _checked_header(path: str | Path, file: OpenExr) -> dict[str, Any]:
    text = description(file)
    if text is None:
        raise MapSetError(f"{path} {A_PICTURE}")
    try:
        header: dict[str, Any] = loads(text)
    except SchemaError as error:
        raise MapSetError(
            f"{path} holds a description that cannot be read ({error}): make the map set again."
        ) from error
    check_header(header, str(path))
    listed = {part["name"]: part["size"] for part in header["parts"]}
    found = {part.get("name", ""): _size(part) for part in file.headers}
    if SMALLEST_TEXEL * sum(width * height for width, height in found.values()) > Path(path).stat().st_size:
        raise MapSetError(f"{path} is truncated: it states more than it can hold; fetch or make it again.")
    found.pop(COVER, None)
    for name in [*listed, *found]:
        if listed.get(name) != found.get(name):
            raise MapSetError(
                f"{path} does not hold what it lists (part {name!r}: {_words(listed.get(name))} in its list, "
                f"{_words(found.get(name))} in fact): make it again."
            )
    return header


def _check_shape(name: str, pixels: Array) -> None:
    if pixels.ndim != 3 or pixels.shape[2] != 3 or not pixels.size:
        raise ShapeError(f"Map {name} must have the shape (height, width, 3), not {pixels.shape}.")


def _stored(name: str, pixels: Array, half: bool) -> Array:
    """Pixels as the file stores them."""
    with np.errstate(over="ignore"):
        stored: Array = np.ascontiguousarray(pixels, dtype="<f4")
    if unusable := int(np.count_nonzero(~np.isfinite(stored))):
        raise RangeError(f"Map {name} holds {unusable} values that are NaN or infinite: make it again.")
    return stored.astype("<f2") if half_states(stored) or (half and half_holds([stored])) else stored


def _derived(stored: Array) -> dict[str, Any]:
    height, width = stored.shape[:2]
    return {"size": [width, height], "sha256": hashlib.sha256(stored.data).hexdigest()}


def _checked_pixels(path: str | Path, listed: dict[str, Any], part: Part) -> Array:
    """A part's pixels as float32, if they are the ones that were written."""
    types = {pixels.dtype.name for pixels in part.channels.values()}
    if part.channels.keys() != set("RGB") or types not in ({"float32"}, {"float16"}):
        raise MapSetError(f"{path} has no R, G and B in float or half in part {part.name!r}: make it again.")
    stored = part.side_by_side("RGB")
    if _derived(stored)["sha256"] != listed["sha256"]:
        raise MapSetError(f"{path} is damaged: part {part.name!r} is not as written; fetch or make it again.")
    unusable = int(np.count_nonzero(~np.isfinite(stored)))
    if unusable:
        raise MapSetError(
            f"{path} holds {unusable} values that are NaN or infinite in part {part.name!r}: make it again."
        )
    return stored.astype(np.float32, copy=False)


def _size(attributes: dict[str, Any]) -> list[int]:
    low, high = attributes["dataWindow"]
    return [int(high[axis]) - int(low[axis]) + 1 for axis in (0, 1)]


def _words(size: list[int] | None) -> str:
    return "missing" if size is None else "{}x{}".format(*size)


@contextlib.contextmanager
def _opened_exr(path: str | Path) -> Iterator[OpenExr]:
    """Open a file that should hold a map set: all its errors, and those of the body, become `MapSetError`."""
    try:
        with opened(path) as stream:
            start = stream.read(max(map(len, PICTURES)))
            if not start.startswith(MAGIC):
                raise MapSetError(f"{path} {A_PICTURE if start.startswith(PICTURES) else NOTHING_KNOWN}")
            yield OpenExr(path, stream)
    except (InputFileError, RangeError) as error:
        raise MapSetError(str(error)) from error
