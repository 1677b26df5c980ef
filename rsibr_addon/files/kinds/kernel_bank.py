"""Map sets of kind `kernel_bank`."""

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any, TypedDict

import numpy as np

from ...core.brdf.spec import brdf_from_spec
from ...core.errors import MapSetError, RangeError, ShapeError
from ...core.kinds.kernel_bank.filtered_bank import FilteredBank, stack_from_bank
from ...core.kinds.kernel_bank.shading import DRAFT, BankLook
from ...core.kinds.lobe_stack.shading import StackLook, stack_radiance
from ...core.kinds.lobe_stack.stack import stack_representation
from ...core.lobes.bake import BakedBank
from ...core.lobes.bank import KernelBank
from ...core.lobes.layers import layered_fit
from ...core.lobes.target import elevation_slices
from ...core.progress import drain
from ...settings.kernel_bank import KernelBankSettings
from ..brdfs import read_measured
from ..map_set_data import ENVIRONMENT, MapSet
from ..map_set_header import Colour, Origin, Shading, StoredKind, make_header, role_in_words
from .sheets import sheets_from_strip, strip_from_sheets

KIND = "kernel_bank"


class _Kernel(TypedDict):
    concentration: float
    bound: Colour
    interpolation: float


def to_map_set(baked: BakedBank, origin: Origin) -> MapSet:
    """A kernel bank as a map set holds it; the bounds are the bank's own, not those of `origin`."""
    filtered = baked.filtered
    maps = {ENVIRONMENT: origin.environment.radiance}
    parts: list[dict[str, Any]] = [{"name": ENVIRONMENT, "role": ENVIRONMENT}]
    for number, sheets in enumerate(filtered.maps.astype(np.float32)):
        name = f"kernel{number:02d}"
        maps[name] = strip_from_sheets(sheets)
        parts.append(
            {
                "name": name,
                "role": "prefiltered",
                "concentration": filtered.bank.concentrations[number],
                "bound": filtered.bound[number].tolist(),
                "interpolation": baked.interpolation[number],
            }
        )
    bound = {"filter": filtered.bound.max(axis=0).tolist(), "interpolation": max(baked.interpolation)}
    size = filtered.size, filtered.size * filtered.maps.shape[1]
    header = make_header(filtered.layout, size, parts, replace(origin, error_bound=bound))
    return MapSet(KIND, maps, header)


def from_map_set(path: Path, map_set: MapSet) -> FilteredBank:
    """A kernel bank as a map set holds it.

    Raises
    ------
    MapSetError
        Its layout is not a kernel bank's, it has no kernels or two equal ones, or a map does not have the
        header's size.
    """
    parts = [part for part in map_set.header["parts"] if part["role"] == "prefiltered"]
    parts.sort(key=lambda part: part["concentration"])
    size = map_set.header["size"][0]
    try:
        shape = stack_representation(map_set.header["layout"], size).shape(size)
        return FilteredBank(
            map_set.header["layout"],
            KernelBank(tuple(part["concentration"] for part in parts)),
            np.array([sheets_from_strip(map_set.maps[part["name"]], shape) for part in parts]),
            np.array([part["bound"] for part in parts], dtype=np.float64),
        )
    except (RangeError, ShapeError) as error:
        raise MapSetError(f"{path} holds no kernel bank. {error}") from error


def _facts(header: dict[str, Any]) -> dict[str, str]:
    return {"Kernels": f"{sum(part['role'] in STORED.roles for part in header['parts'])}"}


def _part_title(part: dict[str, Any]) -> str:
    if part["role"] not in STORED.roles:
        return role_in_words(part)
    return f"Kernel, Concentration {part['concentration']:.3g}"


def _shading(path: Path, map_set: MapSet) -> Shading:
    filtered = from_map_set(path, map_set)
    lobes, slices, taps = DRAFT
    brdf, mu = brdf_from_spec(BankLook().spec, read_measured), elevation_slices(slices)
    fit = drain(layered_fit(brdf, mu, lobes, taps=taps, sharpest=filtered.sharpest))
    stack, _ = stack_from_bank(filtered, fit)
    return partial(stack_radiance, stack, look=StackLook(antialiased=False))


STORED = StoredKind(
    settings=KernelBankSettings,
    look=BankLook,
    roles={"prefiltered": _Kernel},
    facts=_facts,
    part_title=_part_title,
    from_map_set=from_map_set,
    shading=_shading,
)
