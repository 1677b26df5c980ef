"""Reflection tables against what they stand for, integrated over the environment, or against Cycles."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import sqrt
from pathlib import Path
from typing import Any

import numpy as np

from ...core.conventions import Array
from ...core.environment import Environment
from ...core.geometry.camera import Camera
from ...core.kinds.reflection_tables.integral import lobes_reflectance, mirrors
from ...core.kinds.reflection_tables.material import TableMaterial, material_from_texts
from ...core.kinds.reflection_tables.models import PhongTable
from ...core.kinds.reflection_tables.shading import TablesLook
from ...core.kinds.reflection_tables.tables import ReflectionTables
from ...core.progress import Steps
from ...device.kinds.reflection_tables import GpuReflectionTables
from ...files.brdfs import read_measured
from ...host.meshes import TriangleMesh, load_mesh
from ...settings.reflection_tables import TablesComparison
from . import model_or_cycles
from .comparison import cameras_of
from .exact import exact_pictures, picture, rings_of
from .truth import Drawn, Truth

FINER = 4
"""Lookups of mirrors along each side of a sample of a picture."""


@dataclass(frozen=True)
class TablesWay:
    """A way to draw tables.

    Attributes
    ----------
    fade : bool
        Whether lobes fade at the horizon.
    """

    fade: bool

    @property
    def slug(self) -> str:
        """A name for files and reports."""
        return "faded" if self.fade else "tables"

    @property
    def name(self) -> str:
        """A name for people."""
        return "faded at the horizon" if self.fade else "as in the paper"


def draw(
    map_set: Path,
    tables: ReflectionTables,
    environment: Environment,
    material: dict[str, Any],
    settings: TablesComparison,
) -> Steps[Drawn]:
    """Draw a mesh from tables, with and without fade, and from what they stand for: see `Truth.draw`.

    Raises
    ------
    RangeError
        The map set's material is none: see `material_from_texts`.
    """
    model = material_from_texts(tables.parts, read_measured)
    mesh, cameras = load_mesh(settings.mesh), cameras_of(settings)
    if settings.material is None:
        rings = settings.rings or _rings(model)
        settings = replace(settings, rings=rings)
        truth: model_or_cycles.Pictures = yield from _by_model(
            model, environment, mesh, cameras, settings.size, rings
        )
    else:
        truth = yield from model_or_cycles.by_cycles(environment, mesh, cameras, settings)
    ours = GpuReflectionTables(tables)
    drawn = {
        way: [picture(ours, TablesLook(fade=way.fade), mesh, camera, settings.size) for camera in cameras]
        for way in (TablesWay(True), TablesWay(False))
    }
    told = ", ".join(f"{part} {text}" for part, text in tables.parts.items())
    return model_or_cycles.beside(
        truth, drawn, told, max(each.shape[1] for each in tables.maps.values()), settings
    )


def _rings(model: TableMaterial) -> int:
    """As many as the narrowest lobe needs."""
    exponents = [each.n for each in model.lobes.values() if isinstance(each, PhongTable)]
    return rings_of(sqrt(2.0 / (max(exponents, default=1.0) + 2.0)))


def _by_model(
    model: TableMaterial,
    environment: Environment,
    mesh: TriangleMesh,
    cameras: Sequence[Camera],
    size: int,
    rings: int,
) -> Steps[model_or_cycles.ByModel]:
    """Lobes by exact sums, and mirrors by many lookups of the environment."""
    pictures = [np.zeros((size, size, 4), dtype=np.float32) for _ in cameras]
    reflectance = lobes_reflectance(model)
    if reflectance is not None:
        pictures = yield from exact_pictures(reflectance, environment, cameras, mesh, size, rings)
    mirrored = mirrors(model, environment.radiance)
    if mirrored is not None:
        content = GpuReflectionTables(mirrored)
        points = TablesLook(antialiased=False)
        finer = [picture(content, points, mesh, camera, FINER * size) for camera in cameras]
        pictures = [_added(*each) for each in zip(pictures, map(_coarser, finer), strict=True)]
    return model_or_cycles.ByModel(pictures)


def _coarser(picture: Array) -> Array:
    """Means of `FINER` x `FINER` pixels."""
    size = len(picture) // FINER
    mean: Array = picture.reshape(size, FINER, size, FINER, 4).mean(axis=(1, 3))
    return mean


def _added(first: Array, second: Array) -> Array:
    """Radiance of both, with the coverage of the second."""
    return np.dstack([first[..., :3] + second[..., :3], second[..., 3]])


def _is_look(way: TablesWay, look: TablesLook) -> bool:
    return look == TablesLook(fade=way.fade)


TRUTH = Truth(
    way=TablesWay,
    draw=draw,
    telling=model_or_cycles.telling,
    is_look=_is_look,
)
