"""The description inside a map set file, of any kind; docs/map-set-format.md in code.

A schema per object: see `core.schema`.
"""

import hashlib
import json
import math
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any, NotRequired, Protocol, TypedDict

from ..core.conventions import WORLD_AXES, Array
from ..core.environment import Environment
from ..core.lobes.fit import Fit
from ..core.options import Options
from ..core.schema import Rule, between, length
from ..settings.comparison import ComparisonOptions
from ..settings.method import MethodSettings
from .map_set_data import ENVIRONMENT, MapSet
from .textures import Texture, Up

FORMAT = 1
"""The version of the format that this code writes, and the only one that it reads."""

MOST_PARTS, MOST_KERNELS = 8192, 64
"""Limits above those of anything that is baked, and within any memory."""

WIDEST = 2**17
"""Width and height of the largest map, in texels."""


def _is_unit(value: list[float]) -> bool:
    # Unit length to six digits, to which a writer may round
    return abs(math.hypot(*value) - 1.0) < 1e-5


Size = Annotated[list[Annotated[int, between(1, WIDEST)]], length(2, 2)]
Colour = Annotated[list[float], length(3, 3)]
Direction = Annotated[Colour, Rule("a unit vector", _is_unit)]
Hash = Annotated[
    str, Rule("64 hexadecimal digits", lambda value: re.fullmatch("[0-9a-f]{64}", value) is not None)
]
Word = Annotated[
    str, Rule("a word of at most 64 letters", lambda value: re.fullmatch(r"[\w.-]{1,64}", value) is not None)
]
"""Part of a file's name, when maps are exported."""


Model = Annotated[str, length(0, 4096)]
"""Text of a reflectance or material."""


Name = Annotated[str, length(1, 255)]
"""Name of a part, as OpenEXR allows it."""


class _Environment(TypedDict):
    name: str
    sha256: Hash
    size: Size
    part: Name | None
    clamp: NotRequired[Annotated[float, Rule("a number above 0", lambda value: value > 0.0)]]


class Material(TypedDict):
    """The material in descriptions of kinds without further fields."""

    name: NotRequired[str]
    brdf: NotRequired[Model]


class _Part(TypedDict):
    name: Name
    role: Word
    size: Size
    sha256: Hash


class Recipe(TypedDict):
    """All that a map set depends on; equal ones make the same map set.

    Attributes
    ----------
    kind : str
    settings : dict
        Every setting of the method, as JSON values; of the files that they name, the names alone.
    clamp : float or None
        Greatest radiance.
    light : str
        SHA-256 of the environment's file, and ``:LAYER`` where one is named; or a fingerprint of the world.
    material : str or None
        Fingerprint of the material, where it is one of a Blender file.
    files : list of str
        SHA-256 of the other files that the settings name.
    software : str
        As in the description.
    """

    kind: str
    settings: dict[str, Any]
    clamp: float | None
    light: str
    material: str | None
    files: list[str]
    software: str


class Painted(TypedDict):
    """Of what a map set was painted.

    Attributes
    ----------
    of : str
        Content hash of the map set that was there before.
    parts : list of str
        The parts that differ.
    """

    of: Hash
    parts: Annotated[list[Name], length(0, MOST_PARTS)]


class Header(TypedDict):
    """The description that all kinds of map sets share."""

    layout: Word
    size: Size
    axes: str
    environment: _Environment
    material: Material
    parts: Annotated[list[_Part], length(1, MOST_PARTS)]
    error_bound: dict[str, float | Annotated[list[float], length(1, MOST_KERNELS)]] | None
    settings: dict[str, Any]
    software: str
    recipe: NotRequired[Recipe]
    painted: NotRequired[Painted]


class Shading(Protocol):
    """How a map set is shaded: see `core.kinds`."""

    def __call__(self, normal: Array, view_dir: Array, *, mirror_footprint: Array) -> Array:
        """Radiance of surface points."""


def role_in_words(part: dict[str, Any]) -> str:
    """The title of a map by its role alone."""
    return str(part["role"]).capitalize()


@dataclass(frozen=True)
class StoredKind:
    """The fields that a kind of map set adds to its description, and their words for people.

    Attributes
    ----------
    settings : type
        How it is made, as options.
    look : type
        How it is shaded, as options; their defaults are the kind's best.
    comparison : type or None
        How it is compared with the truth, as options; None where there is none.
    material : type
        Schema of its material: see `core.schema`.
    roles : mapping of str to type
        Role -> schema of a part's fields beyond name, role, size and hash; parts of other roles have none.
    numbers : tuple of str
        Roles of parts that are small tables of numbers, which a picture would not explain.
    painted : tuple of str
        Roles of parts that people may paint.
    problems : callable
        From a description with all fields to the contradictions in it.
    facts : callable
        From a description to the facts of this kind alone, in words: name -> value.
    part_title : callable
        From one of its parts to the title of its map.
    textures : callable or None
        A file's path, for messages, what it holds, and which axis is to be up, to textures that hold it; None
        where `textures.arrays` makes them.
    shaded : callable
        From a file's path, for messages, and what it holds to the same with the maps that shaders look up.
    suns : callable
        From what a file holds to what docs/export.md says of its suns; None where there are none.
    lobes : callable
        From a file's path, for messages, and its description to the lobes of its maps; None where it does not
        state them.
    from_map_set : callable
        A file's path, for messages, and a `MapSet` to what it holds, its content: see `files.kinds`.
    shading : callable
        A file's path, for messages, and what it holds to how it is shaded where its look is the default one.
    """

    settings: type[MethodSettings]
    look: type[Options]
    comparison: type[ComparisonOptions] | None = None
    material: Any = Material
    roles: Mapping[str, Any] = field(default_factory=dict)
    numbers: tuple[str, ...] = ()
    painted: tuple[str, ...] = ()
    problems: Callable[[dict[str, Any]], Iterator[str]] = lambda header: iter(())
    facts: Callable[[dict[str, Any]], dict[str, str]] = lambda header: {}
    part_title: Callable[[dict[str, Any]], str] = role_in_words
    textures: Callable[[Path, MapSet, Up], list[Texture]] | None = None
    shaded: Callable[[Path, MapSet], MapSet] = lambda path, map_set: map_set
    suns: Callable[[MapSet], dict[str, Any] | None] = lambda map_set: None
    lobes: Callable[[Path, dict[str, Any]], Fit | None] = lambda path, header: None
    from_map_set: Callable[[Path, MapSet], Any] = field(kw_only=True)
    shading: Callable[[Path, MapSet], Shading] = field(kw_only=True)


@dataclass(frozen=True, eq=False)
class Origin:
    """What a map set was made of, and how; the fields are those of docs/map-set-format.md.

    Attributes
    ----------
    environment : Environment
        Embedded under the name `ENVIRONMENT`.
    """

    environment: Environment
    settings: dict[str, Any]
    software: str
    material: dict[str, Any] = field(default_factory=dict)
    error_bound: dict[str, Any] | None = None


def make_header(
    layout: str, size: tuple[int, int], parts: list[dict[str, Any]], origin: Origin
) -> dict[str, Any]:
    """The description of a map set, as `MapSet.header` takes it; `size` is width and height of its maps."""
    environment = origin.environment
    height, width = environment.radiance.shape[:2]
    return {
        "layout": layout,
        "size": list(size),
        "axes": WORLD_AXES,
        "environment": {
            "name": environment.name,
            "sha256": environment.sha256,
            "size": [width, height],
            "part": ENVIRONMENT,
            **({} if environment.clamp is None else {"clamp": environment.clamp}),
        },
        "material": origin.material,
        "parts": parts,
        "error_bound": origin.error_bound,
        "settings": origin.settings,
        "software": origin.software,
    }


def content_hash(header: dict[str, Any]) -> str:
    """A hash of a map set's content: equal for equal map sets, as a description has the hashes of all pixels.

    Parameters
    ----------
    header : dict
        A whole description, from `files.map_set.read_map_set_header`.

    Returns
    -------
    str
        64 hexadecimal digits.
    """
    return hashlib.sha256(json.dumps(header, sort_keys=True).encode()).hexdigest()
