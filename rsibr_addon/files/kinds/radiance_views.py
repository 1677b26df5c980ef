"""Map sets of kind `radiance_views`."""

from pathlib import Path

import numpy as np

from ...core.conventions import Array
from ...core.errors import MapSetError, RangeError, ShapeError
from ...core.kinds.radiance_views.views import RadianceViews
from ..map_set import MapSet


def from_map_set(path: Path, map_set: MapSet) -> RadianceViews:
    """Radiance views as a map set holds them.

    Parameters
    ----------
    path : Path
        The map set's file, for messages.
    map_set : MapSet
        Of this kind.

    Returns
    -------
    RadianceViews

    Raises
    ------
    MapSetError
        Its views are not the 12, 42 or 162 that RSIBR blends.
    """
    parts = map_set.header["parts"]
    directions = {part["view"]: part["view_dir"] for part in parts if part["role"] == "diffuse"}
    # Other writers may not have measured albedo.
    albedo = [map_set.maps[part["name"]] for part in parts if part["role"] == "albedo"]
    if len(albedo) > 1:
        raise MapSetError(f"{path} holds two tables of albedo: capture it again.")
    try:
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
