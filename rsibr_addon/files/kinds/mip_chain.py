"""Map sets of kind `mip_chain`."""

from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Annotated, Any, NotRequired, TypedDict

import numpy as np

from ...core.conventions import WORLD_AXES, Array
from ...core.errors import MapSetError, RangeError, ShapeError
from ...core.geometry.near_room import Room
from ...core.kinds.mip_chain.chain import MipChain
from ...core.kinds.mip_chain.probes import Place, Probe
from ...core.kinds.mip_chain.shading import MipLook, mip_chain_radiance
from ...core.schema import Rule, between, length
from ...core.warned import warn
from ...settings.mip_chain import MipChainSettings, MipComparison
from ..map_set_data import ENVIRONMENT, MapSet
from ..map_set_header import Colour, Origin, Shading, StoredKind, make_header, role_in_words
from ..textures import Texture, Up

KIND = "mip_chain"
HARMONICS = "harmonics"
"""The role of the part that holds the coefficients of diffuse light, and its name."""

Y_UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
"""Directions with Y up, as glTF has them, from Blender's."""

Y_UP_AXES = "right-handed, Y up: (x, y, z) here is (x, -z, y) of Blender's world"


PROBE = "probe"
"""The role of the mips of rooms."""


class _Place(TypedDict):
    room: Annotated[str, Rule("box or sphere", lambda value: value in ("box", "sphere"))]
    size: Annotated[list[Annotated[float, between(1e-6, 1e9)]], length(3, 3)]
    middle: Colour
    captured_at: Colour
    blend: Annotated[float, between(1e-6, 1e9)]


class _ProbeMip(TypedDict):
    probe: Annotated[int, between(1, 255)]
    mip: Annotated[int, between(0, 31)]
    place: NotRequired[_Place]


class _Mip(TypedDict):
    mip: Annotated[int, between(0, 31)]
    roughness: Annotated[float, between(0.0, 1.0)] | None
    spread: NotRequired[Annotated[float, between(0.0, 2.0)]]


def to_map_set(chain: MipChain, origin: Origin) -> MapSet:
    """A mip chain as a map set holds it."""
    maps = {ENVIRONMENT: origin.environment.radiance, HARMONICS: chain.harmonics[None].astype(np.float32)}
    parts: list[dict[str, Any]] = [{"name": name, "role": name} for name in maps]
    for mip, faces in enumerate(chain.mips):
        name = f"mip{mip:02d}"
        roughness = None if chain.roughness is None else chain.roughness[mip]
        maps[name] = _strip(faces)
        spread = {} if chain.spread is None else {"spread": chain.spread[mip]}
        parts.append({"name": name, "role": "prefiltered", "mip": mip, "roughness": roughness, **spread})
    for number, probe in enumerate(chain.probes, 1):
        for mip, faces in enumerate(probe.mips):
            name = f"probe{number:02d}-mip{mip:02d}"
            maps[name] = _strip(faces)
            place = {} if mip else {"place": _stated(probe.place)}
            parts.append({"name": name, "role": PROBE, "probe": number, "mip": mip, **place})
    header = make_header("cube_map", (chain.size, 6 * chain.size), parts, origin)
    return MapSet(KIND, maps, header)


def from_map_set(path: Path, map_set: MapSet) -> MipChain:
    """A mip chain as a map set holds it.

    Raises
    ------
    MapSetError
        It is not laid out as cubes, its mips are not numbered from 0 or do not halve in size, the
        coefficients are missing, or only some mips state a roughness or a spread.
    """
    layout = map_set.header["layout"]
    if layout != "cube_map":
        raise MapSetError(f"{path} holds mips laid out as {layout}, not as cube_map: make it again.")
    filtered = [part for part in map_set.header["parts"] if part["role"] == "prefiltered"]
    mips = {part["mip"]: part for part in filtered}
    tables = [map_set.maps[part["name"]] for part in map_set.header["parts"] if part["role"] == HARMONICS]
    if len(tables) != 1 or not mips or set(mips) != set(range(len(filtered))):
        raise MapSetError(f"{path} lacks its coefficients or one of its mips: make it again.")
    stated = {}
    for name in ("roughness", "spread"):
        known = [value for mip in range(len(mips)) if (value := mips[mip].get(name)) is not None]
        if known and len(known) < len(mips):
            raise MapSetError(f"{path} states the {name} of some of its mips only: make it again.")
        stated[name] = tuple(known) or None
    try:
        return MipChain(
            tuple(_faces(map_set.maps[mips[mip]["name"]]) for mip in range(len(mips))),
            tables[0].reshape(-1, 3).astype(np.float64),
            **stated,
            probes=tuple(_probes(path, map_set)),
        )
    except (RangeError, ShapeError) as error:
        raise MapSetError(f"{path} holds no mip chain. {error}") from error


def _stated(place: Place) -> dict[str, Any]:
    told = {name: list(getattr(place, name)) for name in ("size", "middle", "captured_at")}
    return {"room": str(place.room), **told, "blend": place.blend}


def _probes(path: Path, map_set: MapSet) -> Iterator[Probe]:
    parts = [part for part in map_set.header["parts"] if part["role"] == PROBE]
    for number in range(1, 1 + max((part["probe"] for part in parts), default=0)):
        mips = {part["mip"]: part for part in parts if part["probe"] == number}
        if set(mips) != set(range(len(mips))) or "place" not in mips.get(0, {}):
            raise MapSetError(f"{path} lacks a mip of probe {number}, or its place: make it again.")
        stated = mips[0]["place"]
        at, size, middle = (tuple(stated[name]) for name in ("captured_at", "size", "middle"))
        place = Place(at, Room(stated["room"]), size, middle, stated["blend"])
        yield Probe(place, tuple(_faces(map_set.maps[mips[mip]["name"]]) for mip in range(len(mips))))


def _strip(faces: Array) -> Array:
    """Faces below each other, +X at the top, each with its row 0 at the top: as OpenGL stores a cube."""
    return faces.reshape(-1, *faces.shape[2:])[::-1]


def _faces(strip: Array) -> Array:
    """The inverse of `_strip`; a picture that is not a strip keeps a shape that `MipChain` refuses."""
    height, width = strip.shape[:2]
    if height != 6 * width:
        return strip
    return strip[::-1].reshape(6, width, width, -1)


def _facts(header: dict[str, Any]) -> dict[str, str]:
    mips = sum(part["role"] == "prefiltered" for part in header["parts"])
    probes = sum("place" in part for part in header["parts"])
    return {"Mips": f"{mips}", **({"Probes": f"{probes}"} if probes else {})}


def _part_title(part: dict[str, Any]) -> str:
    if part["role"] not in STORED.roles:
        return role_in_words(part)
    if part["role"] == PROBE:
        return f"Probe {part['probe']}, Mip {part['mip']}"
    sharpness = "" if part["roughness"] is None else f", Roughness {part['roughness']:.2f}"
    return f"Mip {part['mip']}{sharpness}"


def _textures(path: Path, map_set: MapSet, up: Up) -> list[Texture]:
    """A cube, whose texels a turn of axes leaves as they are."""
    chain = from_map_set(path, map_set)
    if chain.probes:
        warn(f"{path.name} has probes of rooms, which the textures do not hold: bake a mip chain of each.")
    turned = chain.turned(Y_UP) if up is Up.Y else chain
    note = {
        "axes": Y_UP_AXES if up is Up.Y else WORLD_AXES,
        "roughness": chain.roughness,
        "spread": chain.spread,
        "numbers": {HARMONICS: {"rows": [turned.harmonics.tolist()]}},
    }
    return [Texture(turned.mips, is_cube=True, note=note)]


def _shading(path: Path, map_set: MapSet) -> Shading:
    return partial(mip_chain_radiance, from_map_set(path, map_set), look=MipLook())


STORED = StoredKind(
    settings=MipChainSettings,
    look=MipLook,
    comparison=MipComparison,
    roles={"prefiltered": _Mip, PROBE: _ProbeMip},
    numbers=(HARMONICS,),
    facts=_facts,
    part_title=_part_title,
    textures=_textures,
    from_map_set=from_map_set,
    shading=_shading,
)
