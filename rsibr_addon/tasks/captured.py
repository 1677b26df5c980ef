"""A capture read back: radiance views, and what they were made of."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..core.conventions import Array
from ..core.environment import Environment
from ..core.errors import MapSetError, RangeError, ShapeError
from ..core.radiance_views import RadianceViews
from ..files.map_set import MapSet, read_map_set

KIND = "radiance_views"


@dataclass(frozen=True)
class Captured:
    """What a map set of radiance views holds.

    Attributes
    ----------
    views : RadianceViews
    environment : Environment or None
        The light it was captured in; None where the file does not hold it.
    material : dict
        Of the map set's header: "spec" and "fingerprint" say which material it was.
    """

    views: RadianceViews
    environment: Environment | None
    material: dict[str, Any]


def read_captured(path: Path) -> Captured:
    """Read a map set of radiance views.

    Parameters
    ----------
    path : Path

    Returns
    -------
    Captured

    Raises
    ------
    MapSetError
        As `files.map_set.read_map_set`; or its views are not the 12, 42 or 162 that RSIBR blends.
    """
    map_set = read_map_set(path, KIND)
    environment = map_set.header["environment"]
    part = environment["part"]
    return Captured(
        _views(path, map_set),
        None if part is None else Environment(map_set.maps[part], environment["name"]),
        map_set.header["material"],
    )


def _views(path: Path, map_set: MapSet) -> RadianceViews:
    directions = {part["view"]: part["view_dir"] for part in map_set.header["parts"] if "view" in part}
    try:
        # Other writers may not have measured albedo.
        albedo = [map_set.maps[part["name"]] for part in map_set.header["parts"] if part["role"] == "albedo"]
        views = RadianceViews(_stack(map_set, "diffuse"), _stack(map_set, "glossy"), *albedo)
    except (RangeError, ShapeError) as error:
        raise MapSetError(f"{path} holds {len(directions)} views. {error}") from error
    # Files may round directions to six digits.
    written = np.array([directions[view] for view in sorted(directions)])
    if np.abs(written - views.sphere.vertices).max() > 1e-5:
        raise MapSetError(f"{path} was captured from other directions than RSIBR's own: capture it again.")
    return views


def _stack(map_set: MapSet, role: str) -> Array:
    """The maps of one role in the order of their views, shape (V, size, size, 3)."""
    names = {part["view"]: part["name"] for part in map_set.header["parts"] if part["role"] == role}
    return np.stack([map_set.maps[names[view]] for view in sorted(names)])
