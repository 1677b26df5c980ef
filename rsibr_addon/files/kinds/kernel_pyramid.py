"""Map sets of kind `kernel_pyramid`."""

from dataclasses import replace
from pathlib import Path
from typing import Any, TypedDict

import numpy as np

from ...core.conventions import Array
from ...core.errors import MapSetError, RangeError, ShapeError
from ...core.kinds.kernel_pyramid.bake import BakedPyramid, FilterErrors
from ...core.kinds.kernel_pyramid.look import PrincipledLook
from ...core.kinds.kernel_pyramid.pyramid import OCTAHEDRAL, Pyramid
from ...core.kinds.kernel_pyramid.shading import Families, principled_radiance
from ...core.lobes.bank import KernelBank
from ...core.lobes.rings import WIDTHS
from ...core.maps import equirect
from ...core.suns import NO_SUNS, Suns, find_suns
from ...settings.kernel_pyramid import KernelPyramidSettings, PyramidComparison
from ..families import shipped_family, shipped_sheen
from ..map_set_data import ENVIRONMENT, MapSet
from ..map_set_header import Colour, Origin, Shading, StoredKind, make_header, role_in_words

KIND = "kernel_pyramid"

MIRROR, KERNEL, LAMBERT, LEANING, RING = "mirror", "prefiltered", "diffuse", "leaning", "ring"
"""Roles of parts: the environment itself, filtered with a kernel, both of `Pyramid.diffuse`, and rings."""


class _Filtered(TypedDict):
    bound: Colour
    interpolation: float


class _Kernel(_Filtered):
    concentration: float


class _Ring(_Filtered):
    width: float


def to_map_set(baked: BakedPyramid, origin: Origin) -> MapSet:
    """A pyramid as a map set holds it; the bounds are the pyramid's own, not those of `origin`."""
    pyramid = baked.pyramid
    maps = {ENVIRONMENT: origin.environment.radiance, MIRROR: pyramid.mirror[0]}
    parts: list[dict[str, Any]] = [{"name": name, "role": name} for name in maps]
    for number, (sheets, errors) in enumerate(zip(pyramid.maps, baked.kernels, strict=True)):
        name = f"kernel{number:02d}"
        maps[name] = sheets[0]
        concentration = pyramid.bank.concentrations[number]
        parts.append({"name": name, "role": KERNEL, "concentration": concentration, **_told(errors)})
    for role, sheet, errors in zip((LAMBERT, LEANING), pyramid.diffuse, baked.diffuse, strict=True):
        maps[role] = sheet
        parts.append({"name": role, "role": role, **_told(errors)})
    for number, (width, errors) in enumerate(zip(WIDTHS, baked.rings, strict=True)):
        name = f"ring{number:02d}"
        maps[name] = pyramid.rings[number]
        parts.append({"name": name, "role": RING, "width": width, **_told(errors)})
    without_sheen = (*baked.kernels, *baked.diffuse)
    bound = {
        "filter": np.max([errors.bound for errors in without_sheen], axis=0).tolist(),
        "interpolation": max(errors.interpolation for errors in without_sheen),
        "sheen": np.max([errors.bound for errors in baked.rings], axis=0).tolist(),
    }
    size = pyramid.mirror.shape[1]
    header = make_header(OCTAHEDRAL.name, (size, size), parts, replace(origin, error_bound=bound))
    return MapSet(KIND, maps, header)


def from_map_set(path: Path, map_set: MapSet) -> Pyramid:
    """A pyramid as a map set holds it; without its environment, lobes show its suns.

    Raises
    ------
    MapSetError
        Its layout is not octahedral; a map is missing, there twice or no square; two kernels are equal; or
        rings are not of our widths.
    """
    layout = map_set.header["layout"]
    if layout != OCTAHEDRAL.name:
        raise MapSetError(f"{path} holds maps laid out as {layout}, not as {OCTAHEDRAL.name}: make it again.")
    parts = map_set.header["parts"]
    single = {}
    for role in (MIRROR, LAMBERT, LEANING):
        found = [map_set.maps[part["name"]] for part in parts if part["role"] == role]
        if len(found) != 1:
            raise MapSetError(f"{path} holds {len(found)} maps of the role {role}, not one: make it again.")
        single[role] = found[0]
    kernels, rings = (
        sorted((part for part in parts if part["role"] == role), key=lambda part: float(part[number]))
        for role, number in ((KERNEL, "concentration"), (RING, "width"))
    )
    if tuple(part["width"] for part in rings) != WIDTHS:
        raise MapSetError(f"{path} lacks the rings that sheen is made of: make it again.")
    of_rings = [map_set.maps[part["name"]] for part in rings]
    try:
        for name, sheets in (("diffuse", [single[LAMBERT], single[LEANING]]), ("ring", of_rings)):
            if len({sheet.shape for sheet in sheets}) != 1:
                raise ShapeError(f"Its {name} maps differ in size: bake it again.")
        return Pyramid(
            KernelBank(tuple(part["concentration"] for part in kernels)),
            single[MIRROR][None],
            tuple(map_set.maps[part["name"]][None] for part in kernels),
            np.stack([single[LAMBERT], single[LEANING]]),
            np.stack(of_rings),
            _suns(map_set),
        )
    except (RangeError, ShapeError) as error:
        raise MapSetError(f"{path} holds no light for own materials. {error}") from error


def shipped_families() -> Families:
    """The families of lobes, and the table of sheen, that come with us.

    Raises
    ------
    InputFileError
        See `files.families.shipped_family`.
    """
    return Families(shipped_family("ggx"), shipped_family("leaning"), shipped_sheen())


def _told(errors: FilterErrors) -> dict[str, Any]:
    return {"bound": errors.bound.tolist(), "interpolation": errors.interpolation}


def _suns(map_set: MapSet) -> Suns:
    embedded = map_set.header["environment"]["part"]
    return NO_SUNS if embedded is None else find_suns(map_set.maps[embedded])


def _shaded(path: Path, map_set: MapSet) -> MapSet:
    """Maps of kernels without suns: half floats with them would leave nothing of the light beside them."""
    pyramid = from_map_set(path, map_set)
    sunless = dict(zip(pyramid.bank.concentrations, pyramid.sunless, strict=True))
    parts = [part for part in map_set.header["parts"] if part["role"] == KERNEL]
    maps = {part["name"]: sunless[part["concentration"]][0] for part in parts}
    return replace(map_set, maps=map_set.maps | maps)


def _told_suns(map_set: MapSet) -> dict[str, Any] | None:
    suns = _suns(map_set)
    if not len(suns):
        return None
    radiance = map_set.maps[map_set.header["environment"]["part"]]
    solid_angle = equirect.texel_solid_angle(*radiance.shape[1::-1])
    whole = float(np.einsum("hwi,hw->", radiance, solid_angle))
    each = [
        {
            "direction": direction.tolist(),
            "irradiance": irradiance.tolist(),
            "share": float(irradiance.sum()) / whole,
        }
        for direction, irradiance in zip(suns.direction, suns.irradiance, strict=True)
    ]
    return {"each": each, "ceiling": suns.ceiling.tolist(), "narrowest": suns.narrowest}


def _facts(header: dict[str, Any]) -> dict[str, str]:
    kernels = [part["concentration"] for part in header["parts"] if part["role"] == KERNEL]
    return {"Kernels": f"{len(kernels)}, the sharpest of concentration {max(kernels, default=0.0):g}"}


def _part_title(part: dict[str, Any]) -> str:
    if part["role"] == RING:
        return f"Ring, Width {part['width']:g}"
    if part["role"] != KERNEL:
        return role_in_words(part)
    return f"Kernel, Concentration {part['concentration']:.3g}"


def _shading(path: Path, map_set: MapSet) -> Shading:
    pyramid, families, surface = from_map_set(path, map_set), shipped_families(), PrincipledLook().surface

    def radiance(normal: Array, view_dir: Array, *, mirror_footprint: Array) -> Array:
        """Of points, as the default material is too rough for footprints to count."""
        return principled_radiance(pyramid, families, surface, normal, view_dir)

    return radiance


STORED = StoredKind(
    settings=KernelPyramidSettings,
    look=PrincipledLook,
    comparison=PyramidComparison,
    roles={KERNEL: _Kernel, LAMBERT: _Filtered, LEANING: _Filtered, RING: _Ring},
    facts=_facts,
    part_title=_part_title,
    shaded=_shaded,
    suns=_told_suns,
    from_map_set=from_map_set,
    shading=_shading,
)
