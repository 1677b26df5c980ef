"""Map sets of which someone has painted maps."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from ..core.conventions import Array
from ..core.errors import MapSetError, RangeError, ShapeError
from .kinds.registry import STORED
from .map_set import read_map_set
from .map_set_data import MapSet


def painted_map_set(source: MapSet, content: str, painted: Mapping[str, Array]) -> MapSet:
    """A map set with other maps, which tells of what it was painted.

    Parameters
    ----------
    source : MapSet
    content : str
        Its content hash: see `map_set_header.content_hash`.
    painted : mapping of str to ndarray, shape (height, width, 3)
        Radiance by the name of a part; negative values become 0.

    Returns
    -------
    MapSet
        Its `painted` names the parts that differ, and those that were painted before. Bounds of their errors
        are left out, and so is the recipe, by which a bake would take it for its own.

    Raises
    ------
    ShapeError
        A map has another size than before.
    RangeError
        A map holds NaN or infinite values.
    """
    maps, names = dict(source.maps), set(source.header.get("painted", {}).get("parts", ()))
    for name, pixels in painted.items():
        height, width = maps[name].shape[:2]
        if pixels.shape[:2] != (height, width):
            found = "x".join(map(str, pixels.shape[1::-1]))
            raise ShapeError(f"The {name} table has {width}x{height} texels, not {found}: resize it back.")
        if not np.all(np.isfinite(pixels)):
            raise RangeError(f"The {name} table holds NaN or infinite values: paint over them.")
        there = np.maximum(pixels, 0.0)
        if not np.array_equal(there, maps[name]):
            names.add(name)
        maps[name] = there
    header = {key: value for key, value in source.header.items() if key != "recipe"}
    bounds = {name: bound for name, bound in (header["error_bound"] or {}).items() if name not in names}
    header["error_bound"] = bounds or None
    header["painted"] = {"of": content, "parts": sorted(names)}
    return MapSet(source.kind, maps, header)


def paintable_maps(path: Path) -> dict[str, Array]:
    """The maps of a map set that people may paint, by the names of their parts.

    Returns
    -------
    dict of str to ndarray, shape (height, width, 3)
        Row 0 at the bottom.

    Raises
    ------
    MapSetError
        It cannot be read, or there are none.
    """
    map_set = read_map_set(path)
    roles = STORED[map_set.kind].painted
    maps = {
        part["name"]: map_set.maps[part["name"]] for part in map_set.header["parts"] if part["role"] in roles
    }
    if not maps:
        raise MapSetError(f"{path.name} has no tables to paint: bake reflection tables.")
    return maps
