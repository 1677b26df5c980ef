"""Captured views to lobes, in a file."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from ...core.brdf.spec import MATERIAL, is_model
from ...core.conventions import Array
from ...core.lobes.bake import filter_environment, sharpest_resolved
from ...core.lobes.bank import KernelBank
from ...core.lobes.captured_light import CapturedLight, captured_light
from ...core.lobes.captures import CapturedFit, fit_captures
from ...core.lobes.family import Family
from ...core.lobes.family_fit import fit_closer_gaussian, fit_closer_ggx
from ...core.lobes.target import elevation_slices
from ...core.progress import Progress, Steps
from ...files.atomic import check_target
from ...files.families import shipped_family
from ...files.fits import write_fit
from ...files.kinds import environment, radiance_views
from ...files.map_set import read_map_set

FAMILIES = {"ggx": fit_closer_ggx, "gaussian": fit_closer_gaussian}
"""Families of glossy lobes that captures may be like, and what fits one of their widths closer."""

ELEVATIONS = 16
"""Elevations of the view that lobes are fitted at."""

LAYOUT, SIZE = "octahedral", 256
"""Of the filtered maps in which captured texels look their light up."""


@dataclass(frozen=True)
class CapturedResult:
    """A fit to captured views, and its figures.

    Attributes
    ----------
    captured : CapturedFit
    seconds : float
        Processor time, without reading.
    """

    captured: CapturedFit
    seconds: float

    def report(self) -> dict[str, Any]:
        """The figures, as JSON values."""
        fit = self.captured.fit
        return {
            "lobes": len(fit.weights),
            "slices": len(fit.mu),
            "taps": fit.taps.shape[2],
            "alpha": list(self.captured.widths),
            "left_out": fit.left_out,
            "seconds": self.seconds,
        }


def shipped_families() -> dict[Family, Callable[[float], Steps[Family]]]:
    """The `FAMILIES`, at the elevations of the fit."""
    mu = elevation_slices(ELEVATIONS)
    return {shipped_family(name).at_elevations(mu): closer for name, closer in FAMILIES.items()}


def filtered_light(radiance: Array) -> CapturedLight:
    """An environment as fits to captures take it: filtered with the families' kernels that it resolves.

    Raises
    ------
    RangeError
        It resolves none.
    """
    resolved = sharpest_resolved(len(radiance))
    kernels = shipped_family("ggx").bank.concentrations
    bank = KernelBank(tuple(each for each in kernels if each <= resolved))
    return captured_light(radiance, bank, partial(filter_environment, layout=LAYOUT, size=SIZE))


def fit_to_captures(
    captures: Path, output: Path, count: int | None = None, force: bool = False
) -> Steps[CapturedResult]:
    """Fit lobes to captured views and write the fit.

    Parameters
    ----------
    captures : Path
        A map set of radiance views, with the light that they were made in.
    output : Path
        NAME.json.
    count : int, optional
        Use so many of the views, the first, only.
    force : bool
        Whether an existing file is replaced.

    Raises
    ------
    MapSetError
        The file holds no radiance views, or not the light that they were made in.
    RangeError
        There are fewer views, they are black, or their light resolves no kernel.
    OutputFileError
    """
    check_target(output, force, (".json",))
    yield Progress(0, 1, f"reading {captures.name}")
    map_set = read_map_set(captures, radiance_views.KIND)
    views = radiance_views.from_map_set(captures, map_set)
    radiance = environment.from_map_set(captures, map_set).radiance
    started = time.process_time()
    yield Progress(0, 1, "filtering the environment")
    light = filtered_light(radiance)
    captured = map_set.header["material"]["spec"]
    spec = captured if is_model(captured) else f"{MATERIAL}:{captured}"
    found = yield from fit_captures(views, light, shipped_families(), spec, count)
    result = CapturedResult(found, time.process_time() - started)
    write_fit(output, found.fit, result.report(), force)
    return result
