"""What the description inside a map set file must say; docs/map-set-format.md in code.

A schema per object: see `core.schema`.
"""

import hashlib
import json
import math
import re
from collections.abc import Iterator
from typing import Annotated, Any, NotRequired, TypedDict

from ..core.conventions import WORLD_AXES
from ..core.environment import Environment
from ..core.errors import MapSetError, SchemaError
from ..core.geometry.geodesic import VERTEX_COUNTS
from ..core.schema import Rule, between, decode, length

FORMAT = 1
"""The version of the format that this code writes, and the only one that it reads."""

ENVIRONMENT = "environment"
"""The role of the part that holds the environment, and its name."""

MOST_PARTS, MOST_LOBES, MOST_ELEVATIONS, MOST_TAPS, MOST_KERNELS = 8192, 1024, 1024, 64, 64
"""More than anything that is baked has, and few enough for any memory."""

WIDEST = 2**17
"""Of a map, in texels."""


def _is_unit(value: list[float]) -> bool:
    # Unit length to what a writer may round to: six digits
    return abs(math.hypot(*value) - 1.0) < 1e-5


type Size = Annotated[list[Annotated[int, between(1, WIDEST)]], length(2, 2)]
type Colour = Annotated[list[float], length(3, 3)]
type Direction = Annotated[Colour, Rule("a unit vector", _is_unit)]
type Hash = Annotated[
    str, Rule("64 hexadecimal digits", lambda value: re.fullmatch("[0-9a-f]{64}", value) is not None)
]
type Word = Annotated[
    str, Rule("a word of at most 64 letters", lambda value: re.fullmatch(r"[\w.-]{1,64}", value) is not None)
]
"""Part of a file's name, when maps are exported."""


type Model = Annotated[str, length(0, 4096)]
"""Of reflectance, or a material, as a text."""


type Name = Annotated[str, length(1, 255)]
"""Of a part: what OpenEXR allows."""


class _Environment(TypedDict):
    name: str
    sha256: Hash
    size: Size
    part: Name | None
    clamp: NotRequired[Annotated[float, Rule("a number above 0", lambda value: value > 0.0)]]


class _Material(TypedDict):
    name: NotRequired[str]
    brdf: NotRequired[Model]


class _Part(TypedDict):
    name: Name
    role: Word
    size: Size
    sha256: Hash


class _Header(TypedDict):
    layout: Word
    size: Size
    axes: str
    environment: _Environment
    material: _Material
    parts: Annotated[list[_Part], length(1, MOST_PARTS)]
    error_bound: dict[str, float | Annotated[list[float], length(1, MOST_KERNELS)]] | None
    settings: dict[str, Any]
    software: str


class _ViewsMaterial(TypedDict):
    spec: Model
    name: str
    fingerprint: str


class _StackMaterial(TypedDict):
    brdf: Model
    method: str


MATERIALS: dict[str, Any] = {
    "radiance_views": _ViewsMaterial,
    "lobe_stack": _StackMaterial,
    "reflection_tables": _Material,
    "mip_chain": _Material,
    "kernel_bank": _Material,
}
"""Kind -> what it says of the material; its keys are the kinds that there are."""


class _View(TypedDict):
    view: Annotated[int, between(0, max(VERTEX_COUNTS) - 1)]
    view_dir: Direction


class Tap(TypedDict):
    """A lookup of a lobe stack's map."""

    tilt: float
    turn: float
    weight: float


class _Elevation(TypedDict):
    mu: float
    taps: Annotated[list[Tap], length(1, MOST_TAPS)]
    scale: Colour
    albedo: Colour


class _Lobe(TypedDict):
    lobe: Annotated[int, between(0, MOST_LOBES - 1)]
    elevations: Annotated[list[_Elevation], length(1, MOST_ELEVATIONS)]


class _Weights(TypedDict):
    rows: list[str]


class _Refraction(TypedDict):
    eta: float


class _Mip(TypedDict):
    mip: Annotated[int, between(0, 31)]
    roughness: Annotated[float, between(0.0, 1.0)] | None


class _Kernel(TypedDict):
    concentration: float
    bound: Colour
    interpolation: float


ROLES: dict[tuple[str, str], Any] = {
    ("radiance_views", "diffuse"): _View,
    ("radiance_views", "glossy"): _View,
    ("lobe_stack", "prefiltered"): _Lobe,
    ("reflection_tables", "weights"): _Weights,
    ("reflection_tables", "refraction"): _Refraction,
    ("mip_chain", "prefiltered"): _Mip,
    ("kernel_bank", "prefiltered"): _Kernel,
}
"""Kind and role -> what a part says beyond `_Part`; parts of other roles say no more."""


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
            **({} if environment.clamp is None else {"clamp": environment.clamp}),
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
    if not isinstance(header, dict) or type(header.get("format")) is not int or header["format"] < 1:
        raise MapSetError(f"{name} states no format version, so it is no map set: make it again.")
    if header["format"] > FORMAT:
        raise MapSetError(
            f"{name} was written by a newer RSIBR (format {header['format']}; this one reads {FORMAT}): "
            f"update RSIBR."
        )
    kind = header.get("kind")
    if not isinstance(kind, str) or kind not in MATERIALS:
        raise MapSetError(f"{name} is a map set of unknown kind {kind!r:.40}: update, or make it again.")
    try:
        _check_types(header, kind)
    except SchemaError as error:
        raise MapSetError(f"{name} is not a whole map set ({error}): make it again.") from error
    for problem in _problems(header, kind):
        raise MapSetError(f"{name} is not a whole map set ({problem}): make it again.")


def _check_types(header: dict[str, Any], kind: str) -> None:
    decode(_Header, header)
    decode(MATERIALS[kind], header["material"], "material")
    for number, part in enumerate(header["parts"]):
        if (kind, part["role"]) in ROLES:
            decode(ROLES[kind, part["role"]], part, f"parts[{number}]")


def _problems(header: dict[str, Any], kind: str) -> Iterator[str]:
    """What does not fit together, where each thing alone is what it must be."""
    parts = {part["name"]: part for part in header["parts"]}
    if len(parts) < len(header["parts"]):
        yield "two parts have one name"
    yield from _environment_problems(header["environment"], parts)
    if kind == "radiance_views":
        yield from _view_problems(header)


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
