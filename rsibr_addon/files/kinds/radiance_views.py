"""Map sets of kind `radiance_views`."""

from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Annotated, Any, NotRequired, TypedDict

import numpy as np

from ...core.conventions import Array
from ...core.errors import MapSetError, RangeError, SchemaError, ShapeError
from ...core.geometry.geodesic import VERTEX_COUNTS
from ...core.kinds.radiance_views.shading import ViewsLook, views_fragment
from ...core.kinds.radiance_views.views import RadianceViews
from ...core.kinds.radiance_views.warping import WarpChoice, Warping, chosen_warping
from ...core.lobes.fit import Fit
from ...core.schema import between
from ...settings.radiance_views import RadianceViewsSettings, ViewsComparison
from ..fits import FitFields, fit_from
from ..map_set_data import MapSet
from ..map_set_header import Direction, Model, Shading, StoredKind, role_in_words

KIND = "radiance_views"

LEFT_OUT = "left_out_"
"""Field of the errors in a description, with a warp: see `RadianceViews.left_out`."""

LOBES, LOBES_LEFT_OUT = "lobes", f"{LEFT_OUT}lobes"
"""Fields of the material and of the errors, where lobes were fitted to the views: see `Fit.left_out`."""


class _Material(TypedDict):
    spec: Model
    name: str
    fingerprint: NotRequired[str]
    lobes: NotRequired[FitFields]


class _View(TypedDict):
    view: Annotated[int, between(0, max(VERTEX_COUNTS) - 1)]
    view_dir: Direction


def from_map_set(path: Path, map_set: MapSet) -> RadianceViews:
    """Radiance views as a map set holds them.

    Raises
    ------
    MapSetError
        Its views' directions are no set that can be blended: see `view_sphere`.
    """
    parts = map_set.header["parts"]
    directions = {part["view"]: part["view_dir"] for part in parts if part["role"] == "diffuse"}
    # Other writers may not have measured albedo.
    albedo = [map_set.maps[part["name"]] for part in parts if part["role"] == "albedo"]
    if len(albedo) > 1:
        raise MapSetError(f"{path} holds two tables of albedo: capture it again.")
    try:
        diffuse, glossy = _stack(map_set, "diffuse"), _stack(map_set, "glossy")
        known = {"albedo": albedo[0]} if albedo else {}
        written = np.array([directions[view] for view in sorted(directions)])
        return RadianceViews(diffuse, glossy, **known, left_out=left_out(map_set.header), view_dirs=written)
    except (RangeError, ShapeError) as error:
        raise MapSetError(f"{path} holds {len(directions)} views. {error}") from error


def left_out(header: dict[str, Any]) -> dict[Warping, float]:
    """The errors of predicted views that a description states: see `RadianceViews.left_out`."""
    stated = header["error_bound"] or {}
    return {warping: stated[LEFT_OUT + warping] for warping in Warping if LEFT_OUT + warping in stated}


def lobes_of(path: Path, header: dict[str, Any]) -> Fit | None:
    """The lobes that were fitted to the views; None where none were.

    Raises
    ------
    MapSetError
        Its values do not make a fit.
    """
    material = header["material"]
    if LOBES not in material:
        return None
    try:
        return fit_from(material[LOBES])
    except (RangeError, SchemaError, ShapeError) as error:
        raise MapSetError(f"{path} describes no lobes ({error}): capture it again.") from error


def _stack(map_set: MapSet, role: str) -> Array:
    """The maps of one role in the order of their views, shape (V, size, size, 3)."""
    names = {part["view"]: part["name"] for part in map_set.header["parts"] if part["role"] == role}
    return np.stack([map_set.maps[names[view]] for view in sorted(names)])


def _problems(header: dict[str, Any]) -> Iterator[str]:
    """Views are numbered from 0, and each has a diffuse and a glossy part of the size stated."""
    views: dict[str, dict[int, list[float]]] = {"diffuse": {}, "glossy": {}}
    for part in header["parts"]:
        if part["role"] in views:
            if part["size"] != header["size"]:
                yield f"part {part['name']!r} has another size than the views"
            if part["view"] in views[part["role"]]:
                yield f"view {part['view']} has two {part['role']} parts"
            views[part["role"]][part["view"]] = part["view_dir"]
    diffuse, glossy = views["diffuse"], views["glossy"]
    if not diffuse or set(diffuse) != set(range(len(diffuse))) or set(glossy) != set(diffuse):
        yield "its views are not each there with a diffuse and a glossy part"
    elif diffuse != glossy:
        yield "a view's diffuse and glossy parts state different directions"


def _facts(header: dict[str, Any]) -> dict[str, str]:
    views = sum(part["role"] == "glossy" for part in header["parts"])
    stated = left_out(header)
    best = {"Best warp": chosen_warping(WarpChoice.AUTO, stated).value} if stated else {}
    material = header["material"]
    source = {} if material["spec"] == material["name"] else {"Material from": material["spec"]}
    return {**source, "Views": f"{views}", **best}


def _part_title(part: dict[str, Any]) -> str:
    role = role_in_words(part)
    return f"View {part['view'] + 1}, {role}" if part["role"] in STORED.roles else role


def _shading(path: Path, map_set: MapSet) -> Shading:
    views = from_map_set(path, map_set)
    return partial(views_fragment, views, warping=chosen_warping(ViewsLook().warping, views.left_out))


STORED = StoredKind(
    settings=RadianceViewsSettings,
    look=ViewsLook,
    comparison=ViewsComparison,
    material=_Material,
    roles={"diffuse": _View, "glossy": _View},
    numbers=("albedo",),
    problems=_problems,
    facts=_facts,
    part_title=_part_title,
    lobes=lobes_of,
    from_map_set=from_map_set,
    shading=_shading,
)
