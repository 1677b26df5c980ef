"""Captured views to lobes."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from ...core.brdf.spec import MATERIAL, is_model
from ...core.conventions import Array
from ...core.kinds.radiance_views.views import RadianceViews
from ...core.lobes.bake import SHARPER, filter_environment, sharpest_resolved
from ...core.lobes.bank import KernelBank
from ...core.lobes.captured_light import CapturedLight, captured_light
from ...core.lobes.captures import CapturedFit, fit_captures
from ...core.lobes.family import Family
from ...core.lobes.family_fit import fit_closer_gaussian, fit_closer_ggx
from ...core.lobes.fit import Fit
from ...core.lobes.target import elevation_slices
from ...core.progress import Progress, Steps
from ...files.families import shipped_family
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

    @property
    def fit(self) -> Fit:
        """See `CapturedFit`."""
        return self.captured.fit

    def report(self) -> dict[str, Any]:
        """The figures, as JSON values."""
        return {
            "source": "captures",
            "lobes": len(self.fit.weights),
            "slices": len(self.fit.mu),
            "taps": self.fit.taps.shape[2],
            "alpha": list(self.captured.widths),
            "left_out": self.fit.left_out,
            "untested": self.captured.untested,
            "seconds": self.seconds,
        }


def shipped_families() -> dict[Family, Callable[[float], Steps[Family]]]:
    """The `FAMILIES`, at the elevations of the fit."""
    mu = elevation_slices(ELEVATIONS)
    return {shipped_family(name).at_elevations(mu): closer for name, closer in FAMILIES.items()}


def filtered_light(radiance: Array) -> CapturedLight:
    """An environment as fits to captures take it: filtered with the families' kernels that it may have.

    Raises
    ------
    RangeError
        It resolves none.
    """
    sharpest = SHARPER * sharpest_resolved(len(radiance))
    kernels = shipped_family("ggx").bank.concentrations
    return light_by(radiance, KernelBank(tuple(each for each in kernels if each <= sharpest)))


def light_by(radiance: Array, bank: KernelBank) -> CapturedLight:
    """An environment filtered with some kernels, to look captured texels' light up in.

    Parameters
    ----------
    radiance : ndarray, shape (height, 2 * height, 3)
    bank : KernelBank
        None sharper than `filter_environment` takes.
    """
    return captured_light(radiance, bank, partial(filter_environment, layout=LAYOUT, size=SIZE))


@dataclass(frozen=True)
class Captures:
    """What a map set of radiance views says.

    Attributes
    ----------
    views : RadianceViews
    radiance : ndarray, shape (height, 2 * height, 3)
        The light that they were made in.
    spec : str
        What was captured, as `tasks.reflectance.brdfs.load_brdf` takes it.
    noise : float
        Relative standard error of their texels.
    """

    views: RadianceViews
    radiance: Array
    spec: str
    noise: float


def read_captures(path: Path) -> Captures:
    """Read radiance views.

    Raises
    ------
    MapSetError
        The file holds no radiance views, or not the light that they were made in.
    """
    map_set = read_map_set(path, radiance_views.KIND)
    views = radiance_views.from_map_set(path, map_set)
    captured = map_set.header["material"]["spec"]
    spec = captured if is_model(captured) else f"{MATERIAL}:{captured}"
    noise = float((map_set.header["error_bound"] or {}).get("relative_noise", 0.0))
    return Captures(views, environment.from_map_set(path, map_set).radiance, spec, noise)


def captured_fit(captures: Captures, count: int | None = None) -> Steps[CapturedResult]:
    """Fit lobes to captured views.

    Parameters
    ----------
    captures : Captures
    count : int, optional
        Use so many of the views, the first, only.

    Raises
    ------
    RangeError
        There are fewer views, they are black, or their light resolves no kernel.
    """
    started = time.process_time()
    yield Progress(0, 1, "filtering the environment")
    light = filtered_light(captures.radiance)
    found = yield from fit_captures(captures.views, light, shipped_families(), captures.spec, count)
    return CapturedResult(found, time.process_time() - started)


def is_reached(goal: float | None, left_out: float | None) -> bool:
    """Whether there is a goal, and a stated error that is as small; see `Fit.left_out`."""
    return goal is not None and left_out is not None and left_out <= goal
