"""Map sets of kind `lobe_stack`."""

import math
from collections import defaultdict
from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import partial
from itertools import chain
from pathlib import Path
from typing import Annotated, Any, NotRequired, TypedDict

import numpy as np

from ...core.conventions import Array
from ...core.environment import Environment
from ...core.errors import MapSetError, RangeError, SchemaError, ShapeError
from ...core.kinds.kernel_bank.filtered_bank import maps_from_bank
from ...core.kinds.lobe_stack.shading import StackLook, stack_radiance
from ...core.kinds.lobe_stack.stack import LobeStack, stack_representation
from ...core.kinds.lobe_stack.sunlight import Sunlight, take_suns_apart
from ...core.lobes.bake import BakedStack
from ...core.lobes.bank import BROADEST, SHARPEST, KernelBank
from ...core.lobes.fit import Fit
from ...core.schema import array, between, decode, length
from ...settings.lobe_stack import LobeStackSettings, StackComparison
from ..map_set_data import ENVIRONMENT, MapSet, MapsInTurn
from ..map_set_header import (
    MOST_KERNELS,
    Colour,
    Model,
    Origin,
    Shading,
    StoredKind,
    make_header,
    role_in_words,
)
from .sheets import sheets_from_strip, strip_from_sheets

KIND = "lobe_stack"

MOST_LOBES, MOST_ELEVATIONS, MOST_TAPS = 1024, 1024, 64
"""Limits above those of anything that is baked, and within any memory."""

PROFILES = "profiles"
"""Field of the material with the lobes' shapes, for information."""

_DIGITS = 6
"""Significant digits of a profile's weights."""


class _Material(TypedDict):
    brdf: Model
    method: str


class _Tap(TypedDict):
    tilt: float
    turn: float
    weight: float


class _Elevation(TypedDict):
    mu: float
    taps: Annotated[list[_Tap], length(1, MOST_TAPS)]
    scale: Colour
    albedo: Colour


class _Lobe(TypedDict):
    lobe: Annotated[int, between(0, MOST_LOBES - 1)]
    elevations: Annotated[list[_Elevation], length(1, MOST_ELEVATIONS)]


class _Profiles(TypedDict):
    concentrations: Annotated[list[float], length(1, MOST_KERNELS)]
    sharpest_in_maps: NotRequired[Annotated[float, between(BROADEST, SHARPEST)]]
    weights: list[list[list[Colour]]]


def to_map_set(stack: LobeStack, origin: Origin) -> MapSet:
    """A lobe stack as a map set holds it."""
    size = stack.size, stack.size * stack.maps.shape[2]
    header = make_header(stack.layout, size, _parts(stack, stack.maps.shape[1]), origin)
    maps = _maps(origin.environment, (sheets for lobe in stack.maps for sheets in lobe))
    return MapSet(KIND, dict(zip((part["name"] for part in header["parts"]), maps, strict=True)), header)


def in_turn(baked: BakedStack, origin: Origin) -> MapsInTurn:
    """A baked stack as a map set holds it, with its maps summed one after another.

    Material and bounds are the stack's own, not those of `origin`.
    """
    fit, filtered = baked.fit, baked.filtered
    size = filtered.size, filtered.size * filtered.maps.shape[1]
    bounds: dict[str, Any] = {"filter": baked.bound.tolist(), "interpolation": baked.interpolation}
    if baked.interpolation_suns_apart != baked.interpolation:
        bounds["interpolation_suns_apart"] = baked.interpolation_suns_apart
    if fit.left_out is not None:
        bounds["left_out"] = fit.left_out
    made = replace(
        origin,
        material={"brdf": fit.brdf, "method": fit.method, PROFILES: profiles(fit, baked.sharpest)},
        error_bound=bounds,
    )
    header = make_header(filtered.layout, size, _parts(fit, fit.weights.shape[1]), made)
    shapes = {part["name"]: size[::-1] for part in header["parts"]}
    shapes[ENVIRONMENT] = origin.environment.radiance.shape[:2]
    return MapsInTurn(
        KIND, shapes, _maps(origin.environment, maps_from_bank(filtered, baked.in_maps)), header
    )


def _parts(lobes: Fit | LobeStack, map_count: int) -> list[dict[str, Any]]:
    """The header's parts, for a number of maps of each lobe."""
    parts: list[dict[str, Any]] = [{"name": ENVIRONMENT, "role": ENVIRONMENT}]
    for lobe in range(len(lobes.scale)):
        elevations = [_elevation(lobes, lobe, number) for number in range(len(lobes.mu))]
        for number in range(map_count):
            name = f"lobe{lobe:02d}.slice{number:03d}"
            served = elevations if map_count == 1 else [elevations[number]]
            parts.append({"name": name, "role": "prefiltered", "lobe": lobe, "elevations": served})
    return parts


def _maps(environment: Environment, sheets: Iterable[Array]) -> Iterable[Array]:
    return chain([environment.radiance], map(strip_from_sheets, sheets))


def profiles(fit: Fit, sharpest: float = np.inf) -> dict[str, Any]:
    """The shapes of a fit's lobes, for a map set's material under `PROFILES`.

    Parameters
    ----------
    fit : Fit
    sharpest : float
        Concentration of the kernel that stands for sharper ones in the maps.
    """
    rounded = np.vectorize(lambda value: float(f"{value:.{_DIGITS}g}"))
    concentrations = fit.bank.kappa[fit.used]
    stands_in = {"sharpest_in_maps": sharpest} if np.any(concentrations > sharpest) else {}
    return {
        "concentrations": concentrations.tolist(),
        **stands_in,
        "weights": rounded(fit.weights[:, :, fit.used]).tolist(),
    }


def fit_of(path: Path, header: dict[str, Any]) -> Fit | None:
    """The fit that a lobe stack was made from.

    Parameters
    ----------
    path : Path
        The map set's file, for messages.
    header : dict
        A description of this kind.

    Returns
    -------
    Fit or None
        With profiles to 6 digits; None where the file does not state them.

    Raises
    ------
    MapSetError
        The profiles do not fit the file's lobes.
    """
    material = header["material"]
    if PROFILES not in material:
        return None
    try:
        told = decode(_Profiles, material[PROFILES], PROFILES)
        tables = _tables(_by_lobe(header["parts"]))
        taps = _taps(tables)
        return Fit(
            brdf=material["brdf"],
            method=material["method"],
            mu=np.array([elevation["mu"] for elevation in tables[0]]),
            bank=KernelBank(tuple(told["concentrations"])),
            weights=array(told["weights"], 4, "weights"),
            scale=_array(tables, lambda elevation: elevation["scale"]),
            offsets=taps[..., :2],
            taps=taps[..., 2],
        )
    except (SchemaError, RangeError, ShapeError) as error:
        raise MapSetError(f"{path} describes no lobes ({error}): bake it again.") from error


def from_map_set(path: Path, map_set: MapSet) -> LobeStack:
    """A lobe stack as a map set holds it, its suns apart; without profiles or environment they stay in maps.

    Raises
    ------
    MapSetError
        Its layout is not a lobe stack's, its lobes are not numbered from 0 or do not have the same elevations
        and numbers of maps and taps, its profiles are not those of its lobes, or a map does not have the
        header's size.
    """
    lobes = _parts_by_lobe(path, map_set)
    tables = _tables(lobes)
    used_at = [[(elevation["mu"], len(elevation["taps"])) for elevation in table] for table in tables]
    counts = {(len(lobe), taps) for lobe, used in zip(lobes, used_at, strict=True) for _, taps in used}
    if any(used != used_at[0] for used in used_at) or len(counts) > 1:
        raise MapSetError(f"{path} holds lobes of different elevations, maps or taps: bake it again.")
    layout, (size, _) = map_set.header["layout"], map_set.header["size"]
    taps = _taps(tables)
    try:
        sheets = stack_representation(layout, size).shape(size)
        maps = np.array(
            [[sheets_from_strip(map_set.maps[part["name"]], sheets) for part in lobe] for lobe in lobes]
        )
        return LobeStack(
            layout=layout,
            mu=np.array([mu for mu, _ in used_at[0]]),
            maps=maps,
            scale=_array(tables, lambda elevation: elevation["scale"]),
            offsets=taps[..., :2],
            taps=taps[..., 2],
            albedo=_array(tables, lambda elevation: elevation["albedo"]),
            sunlight=_sunlight(path, map_set, maps),
        )
    except (RangeError, ShapeError) as error:
        raise MapSetError(f"{path} holds no lobe stack. {error}") from error


def _sunlight(path: Path, map_set: MapSet, maps: Array) -> Sunlight | None:
    """What is taken out of maps, shape (L, P, sheets, size, size, 3), in place."""
    fit, embedded = fit_of(path, map_set.header), map_set.header["environment"]["part"]
    if fit is None or embedded is None:
        return None
    if fit.weights.shape[:2] != maps.shape[:2]:
        raise ShapeError("Its profiles are not those of its maps.")
    sheets = stack_representation(map_set.header["layout"], maps.shape[-2])
    sharpest = map_set.header["material"][PROFILES].get("sharpest_in_maps", np.inf)
    texel_dir = sheets.texel_directions(maps.shape[-2])
    return take_suns_apart(maps, texel_dir, fit, sharpest, map_set.maps[embedded])


def _parts_by_lobe(path: Path, map_set: MapSet) -> list[list[dict[str, Any]]]:
    """The parts of every lobe by their elevations."""
    width, height = map_set.header["size"]
    for part in map_set.header["parts"]:
        if part["role"] == "prefiltered" and map_set.maps[part["name"]].shape[:2] != (height, width):
            raise MapSetError(f"{path} holds maps of another size than it says: bake it again.")
    try:
        return _by_lobe(map_set.header["parts"])
    except SchemaError as error:
        raise MapSetError(f"{path} lacks one of its lobes: bake it again.") from error


def _by_lobe(parts: list[dict[str, Any]]) -> list[list[dict[str, Any]]]:
    lobes: dict[int, list[dict[str, Any]]] = defaultdict(list)
    for part in parts:
        if part["role"] == "prefiltered":
            lobes[part["lobe"]].append(part)
    by_elevation = {
        lobe: sorted(its, key=lambda part: part["elevations"][0]["mu"]) for lobe, its in lobes.items()
    }
    if not by_elevation or set(by_elevation) != set(range(len(by_elevation))):
        raise SchemaError("its lobes are not numbered from 0")
    return [by_elevation[lobe] for lobe in range(len(by_elevation))]


def _tables(lobes: list[list[dict[str, Any]]]) -> list[list[dict[str, Any]]]:
    """The elevations of every lobe."""
    return [[elevation for part in lobe for elevation in part["elevations"]] for lobe in lobes]


def _taps(tables: list[list[dict[str, Any]]]) -> Array:
    fields = _Tap.__annotations__
    return _array(
        tables, lambda elevation: [[tap[field] for field in fields] for tap in elevation["taps"]], axes=4
    )


def _elevation(lobes: Fit | LobeStack, lobe: int, number: int) -> dict[str, Any]:
    offsets, weights = lobes.offsets[lobe, number], lobes.taps[lobe, number]
    return {
        "mu": float(lobes.mu[number]),
        "taps": [
            dict(zip(_Tap.__annotations__, (*offset, weight), strict=True))
            for offset, weight in zip(offsets.tolist(), weights.tolist(), strict=True)
        ],
        "scale": lobes.scale[lobe, number].tolist(),
        "albedo": lobes.albedo[lobe, number].tolist(),
    }


def _array(
    tables: list[list[dict[str, Any]]], value: Callable[[dict[str, Any]], Any], axes: int = 3
) -> Array:
    """A value of every elevation of every lobe."""
    return array([[value(elevation) for elevation in table] for table in tables], axes, "elevations")


def _facts(header: dict[str, Any]) -> dict[str, str]:
    lobes = [part for part in header["parts"] if part["role"] in STORED.roles]
    elevations = {elevation["mu"] for part in lobes for elevation in part["elevations"]}
    return {"Lobes": f"{len({part['lobe'] for part in lobes})}, {len(elevations)} view elevations"}


def _part_title(part: dict[str, Any]) -> str:
    if part["role"] not in STORED.roles:
        return role_in_words(part)
    first, *others = part["elevations"]
    angle = math.degrees(math.acos(min(first["mu"], 1.0)))
    at = "All Views" if others else f"Seen at {angle:.0f}\N{DEGREE SIGN}"
    return f"Lobe {part['lobe'] + 1}, {at}"


def _shading(path: Path, map_set: MapSet) -> Shading:
    return partial(stack_radiance, from_map_set(path, map_set), look=StackLook(antialiased=False))


STORED = StoredKind(
    settings=LobeStackSettings,
    look=StackLook,
    comparison=StackComparison,
    material=_Material,
    roles={"prefiltered": _Lobe},
    facts=_facts,
    part_title=_part_title,
    lobes=fit_of,
    from_map_set=from_map_set,
    shading=_shading,
)
