"""What the description inside a map set file must say; docs/map-set-format.md in code.

A rule table per object: field -> (what it must be, in words; how that is checked).
"""

import hashlib
import json
import math
import re
from collections.abc import Callable, Iterator
from typing import Any

from ..core.conventions import WORLD_AXES
from ..core.environment import Environment
from ..core.errors import MapSetError

FORMAT = 1
"""The version of the format that this code writes, and the only one that it reads."""

ENVIRONMENT = "environment"
"""The role of the part that holds the environment, and its name."""

type Rule = tuple[str, Callable[[Any], bool]]


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def _is_index(value: Any) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and value >= 0


def _is_size(value: Any) -> bool:
    return isinstance(value, list) and len(value) == 2 and all(_is_index(n) and n > 0 for n in value)


def _is_colour(value: Any) -> bool:
    return isinstance(value, list) and len(value) == 3 and all(_is_number(n) for n in value)


def _is_direction(value: Any) -> bool:
    # Unit length to what a writer may round to: six digits
    return _is_colour(value) and abs(math.hypot(*value) - 1.0) < 1e-5


def _is_hash(value: Any) -> bool:
    return isinstance(value, str) and re.fullmatch("[0-9a-f]{64}", value) is not None


TEXT: Rule = ("text", lambda value: isinstance(value, str))
NUMBER: Rule = ("a finite number", _is_number)
NUMBER_OR_NULL: Rule = ("a finite number or null", lambda value: value is None or _is_number(value))
INDEX: Rule = ("a whole number from 0", _is_index)
SIZE: Rule = ("[width, height]", _is_size)
COLOUR: Rule = ("three numbers", _is_colour)
DIRECTION: Rule = ("a unit vector", _is_direction)
HASH: Rule = ("64 hexadecimal digits", _is_hash)
OBJECT: Rule = ("an object", lambda value: isinstance(value, dict))
OBJECT_OR_NULL: Rule = ("an object or null", lambda value: value is None or isinstance(value, dict))
TEXTS: Rule = (
    "a list of texts",
    lambda value: isinstance(value, list) and all(isinstance(item, str) for item in value),
)
TEXT_OR_NULL: Rule = ("text or null", lambda value: value is None or isinstance(value, str))
OBJECTS: Rule = (
    "a list of at least one object",
    lambda value: isinstance(value, list) and bool(value) and all(isinstance(item, dict) for item in value),
)

HEADER: dict[str, Rule] = {
    "layout": TEXT,
    "size": SIZE,
    "axes": TEXT,
    "environment": OBJECT,
    "material": OBJECT,
    "parts": OBJECTS,
    "error_bound": OBJECT_OR_NULL,
    "settings": OBJECT,
    "software": TEXT,
}
ENVIRONMENT_FIELDS: dict[str, Rule] = {"name": TEXT, "sha256": HASH, "size": SIZE, "part": TEXT_OR_NULL}
PART_FIELDS: dict[str, Rule] = {"name": TEXT, "role": TEXT, "size": SIZE, "sha256": HASH}

MATERIAL_FIELDS: dict[str, dict[str, Rule]] = {
    "radiance_views": {"spec": TEXT, "name": TEXT, "fingerprint": TEXT},
    "lobe_stack": {"brdf": TEXT, "method": TEXT},
    "reflection_tables": {},
    "mip_chain": {},
    "kernel_bank": {},
}
"""Kind -> what it says of the material; its keys are the kinds that there are."""

_VIEW: dict[str, Rule] = {"view": INDEX, "view_dir": DIRECTION}
ROLE_FIELDS: dict[tuple[str, str], dict[str, Rule]] = {
    ("radiance_views", "diffuse"): _VIEW,
    ("radiance_views", "glossy"): _VIEW,
    ("radiance_views", "albedo"): {},
    ("lobe_stack", "prefiltered"): {"lobe": INDEX, "elevations": OBJECTS},
    ("reflection_tables", "weights"): {"rows": TEXTS},
    ("reflection_tables", "refraction"): {"eta": NUMBER},
    ("mip_chain", "prefiltered"): {"mip": INDEX, "roughness": NUMBER_OR_NULL},
    ("mip_chain", "harmonics"): {},
    ("kernel_bank", "prefiltered"): {"concentration": NUMBER, "bound": COLOUR, "interpolation": NUMBER},
}
"""Kind and role -> what a part says beyond `PART_FIELDS`; parts of other roles say no more."""

ELEVATION_FIELDS: dict[str, Rule] = {"mu": NUMBER, "taps": OBJECTS, "scale": COLOUR, "albedo": COLOUR}
TAP_FIELDS: dict[str, Rule] = {"tilt": NUMBER, "turn": NUMBER, "weight": NUMBER}
"""Of a lobe stack's maps, and of their lookups at each elevation."""


def make_header(
    layout: str,
    size: tuple[int, int],
    environment: Environment,
    embedded: bool,
    material: dict[str, Any],
    parts: list[dict[str, Any]],
    error_bound: dict[str, Any] | None,
    settings: dict[str, Any],
    software: str,
) -> dict[str, Any]:
    """The description of a map set, as `MapSet.header` takes it.

    Parameters
    ----------
    layout : str
    size : tuple of two int
        Width and height of the maps.
    environment : Environment
    embedded : bool
        Whether one of `parts` is the environment, by the name `ENVIRONMENT`.
    material, parts, error_bound, settings, software
        See docs/map-set-format.md.

    Returns
    -------
    dict
    """
    height, width = environment.radiance.shape[:2]
    return {
        "layout": layout,
        "size": list(size),
        "axes": WORLD_AXES,
        "environment": {
            "name": environment.name,
            "sha256": environment.sha256,
            "size": [width, height],
            "part": ENVIRONMENT if embedded else None,
        },
        "material": material,
        "parts": parts,
        "error_bound": error_bound,
        "settings": settings,
        "software": software,
    }


def content_hash(header: dict[str, Any]) -> str:
    """A hash that map sets share if they hold the same: a description has the hash of each part's pixels.

    Parameters
    ----------
    header : dict
        A whole description, as `files.map_set.read_map_set_header` reads it.

    Returns
    -------
    str
        64 hexadecimal digits.
    """
    return hashlib.sha256(json.dumps(header, sort_keys=True).encode()).hexdigest()


def check_header(header: Any, name: str) -> None:
    """Check the description of a map set against the format.

    Parameters
    ----------
    header : object
        What the JSON text holds.
    name : str
        The file, for messages.

    Raises
    ------
    MapSetError
        It is of a newer version or an unknown kind; a field is missing or not what it must be; two
        parts have one name; the environment's part, or a view's diffuse or glossy part, is missing.
    """
    if not isinstance(header, dict) or not _is_index(header.get("format")) or header["format"] < 1:
        raise MapSetError(f"{name} states no format version, so it is no map set: make it again.")
    if header["format"] > FORMAT:
        raise MapSetError(
            f"{name} was written by a newer RSIBR (format {header['format']}; this one reads {FORMAT}): "
            f"update RSIBR."
        )
    kind = header.get("kind")
    if kind not in MATERIAL_FIELDS:
        raise MapSetError(f"{name} is a map set of unknown kind {kind!r}: update, or make it again.")
    for problem in _problems(header, kind):
        raise MapSetError(f"{name} is not a whole map set ({problem}): make it again.")


def _problems(header: dict[str, Any], kind: str) -> Iterator[str]:
    """What is wrong, the first things first: later checks rely on the earlier ones."""
    yield from _broken_rules(header, HEADER, "")
    yield from _broken_rules(header["environment"], ENVIRONMENT_FIELDS, "environment.")
    yield from _broken_rules(header["material"], MATERIAL_FIELDS[kind], "material.")
    for i, part in enumerate(header["parts"]):
        yield from _broken_rules(part, PART_FIELDS, f"parts[{i}].")
        yield from _broken_rules(part, ROLE_FIELDS.get((kind, part["role"]), {}), f"parts[{i}].")
    parts = {part["name"]: part for part in header["parts"]}
    if len(parts) < len(header["parts"]):
        yield "two parts have one name"
    yield from _environment_problems(header["environment"], parts)
    if kind == "radiance_views":
        yield from _view_problems(header)
    elif kind == "lobe_stack":
        yield from _elevation_problems(header)


def _broken_rules(fields: dict[str, Any], rules: dict[str, Rule], where: str) -> Iterator[str]:
    for field, (words, holds) in rules.items():
        if field not in fields:
            yield f"{where}{field} is missing"
        elif not holds(fields[field]):
            yield f"{where}{field} is not {words}"


def _environment_problems(environment: dict[str, Any], parts: dict[str, dict[str, Any]]) -> Iterator[str]:
    name = environment["part"]
    if name is None:
        return
    if name not in parts or parts[name]["role"] != ENVIRONMENT:
        yield f"environment.part names {name!r}, which is no part with that role"
    elif parts[name]["size"] != environment["size"]:
        yield f"part {name!r} has another size than environment.size"


def _view_problems(header: dict[str, Any]) -> Iterator[str]:
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


def _elevation_problems(header: dict[str, Any]) -> Iterator[str]:
    """Every elevation that a map is for says how the map is looked up there."""
    for i, part in enumerate(header["parts"]):
        if part["role"] != "prefiltered":
            continue
        for j, elevation in enumerate(part["elevations"]):
            where = f"parts[{i}].elevations[{j}]."
            yield from _broken_rules(elevation, ELEVATION_FIELDS, where)
            for k, tap in enumerate(elevation["taps"]):
                yield from _broken_rules(tap, TAP_FIELDS, f"{where}taps[{k}].")
