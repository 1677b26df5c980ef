"""The toy kind in files. As a module of `files/kinds`."""

from pathlib import Path
from typing import Any, TypedDict

import numpy as np
from rsibr.rsibr_addon.core.environment import Environment
from rsibr.rsibr_addon.files.map_set_data import ENVIRONMENT, MapSet
from rsibr.rsibr_addon.files.map_set_header import Origin, Shading, StoredKind, make_header
from rsibr.tests.toys.disk_core import Disk, DiskLook, disk_radiance
from rsibr.tests.toys.disk_settings import DiskComparison, DiskSettings

KIND = "disk"


class _Material(TypedDict):
    name: str
    shine: float


class _Colour(TypedDict):
    cosine: float


def to_map_set(disk: Disk, environment: Environment, shine: float) -> MapSet:
    maps = {ENVIRONMENT: environment.radiance}
    parts: list[dict[str, Any]] = [{"name": ENVIRONMENT, "role": ENVIRONMENT}]
    for cosine, colour in enumerate((disk.rim, disk.middle)):
        maps[f"colour{cosine}"] = np.full((2, 2, 3), colour, dtype=np.float32)
        parts.append({"name": f"colour{cosine}", "role": "colour", "cosine": cosine})
    material = {"name": "paper", "shine": shine}
    header = make_header("octahedral", (2, 2), parts, Origin(environment, {}, "a test", material))
    return MapSet(KIND, maps, header)


def from_map_set(path: Path, map_set: MapSet) -> Disk:
    rim, middle = (map_set.maps[name][0, 0].astype(np.float64) for name in ("colour0", "colour1"))
    return Disk(middle, rim)


def _shading(path: Path, map_set: MapSet) -> Shading:
    disk = from_map_set(path, map_set)
    return lambda normal, view_dir, *, mirror_footprint: disk_radiance(disk, normal, view_dir, DiskLook())


def _facts(header: dict[str, Any]) -> dict[str, str]:
    return {"Shine": f"{header['material']['shine']:.0%}"}


def _part_title(part: dict[str, Any]) -> str:
    return f"Colour at n\N{DOT OPERATOR}v {part['cosine']:g}" if "cosine" in part else "Light"


STORED = StoredKind(
    DiskSettings,
    DiskLook,
    DiskComparison,
    _Material,
    {"colour": _Colour},
    facts=_facts,
    part_title=_part_title,
    from_map_set=from_map_set,
    shading=_shading,
)
