"""An environment and a reflectance model, or its fit, to a lobe stack, in a map set."""

import warnings
from dataclasses import dataclass, replace
from itertools import count
from pathlib import Path

from ...core.brdf.model import Brdf
from ...core.environment import Environment
from ...core.errors import RsibrWarning
from ...core.filtering.prefilter import BYTES_BESIDES
from ...core.kinds.lobe_stack.stack import LAYOUTS, stack_representation
from ...core.lobes.accuracy import fit_errors
from ...core.lobes.bake import BakedStack, bake_stack, sharpest_resolved
from ...core.lobes.fit import Fit
from ...core.progress import Progress, Steps
from ...files.atomic import check_target
from ...files.fits import read_fit
from ...files.kinds.lobe_stack import in_turn
from ...files.map_set import write_map_set
from ...files.memory import check_memory
from ...host.version import software
from ..light.environments import load_environment
from ..reflectance.brdfs import load_brdf
from ..reflectance.fit_lobes import METHODS, FitSettings

TOLD_INTERPOLATION = 0.01
"""Relative error that lookups may be expected to cost before somebody is told."""


@dataclass(frozen=True)
class StackSettings:
    """How maps are laid out and stored.

    Attributes
    ----------
    layout : str
        One of `core.kinds.lobe_stack.stack.LAYOUTS`.
    size : int or None
        Width of the maps in texels; None for what the lobes need.
    half : bool
        Store 16-bit floats.

    Raises
    ------
    RangeError
        There is no such layout, or the size is out of range.
    """

    layout: str = LAYOUTS[0]
    size: int | None = None
    half: bool = False

    def __post_init__(self) -> None:
        stack_representation(self.layout, 2 if self.size is None else self.size)


def bake_brdf(
    environment: str | None,
    spec: str,
    fitting: FitSettings,
    settings: StackSettings,
    output: Path,
    force: bool = False,
    clamp: float | None = None,
) -> Steps[BakedStack]:
    """Fit lobes to a model and filter an environment with them.

    Parameters
    ----------
    environment : str or None
        A latitude-longitude file, a name of one of Blender's own, or None for the open file's world:
        see `load_environment`.
    spec : str
        The model: see `tasks.reflectance.brdfs.load_brdf`.
    fitting : FitSettings
    settings : StackSettings
    output : Path
        By custom NAME.rsibr.exr.
    force : bool
        Whether an existing file is replaced.
    clamp : float, optional
        See `core.environment.usable_radiance`.

    Yields
    ------
    Progress

    Returns
    -------
    BakedStack
        What was written, before rounding to half floats.

    Raises
    ------
    InputFileError, OutputFileError, SceneError, RenderError
    RangeError
        The text describes no model; the environment resolves no kernel at all, light is too bright for half
        floats, or the maps are too large for this machine's memory.

    Warns
    -----
    RsibrWarning
        See `load_brdf` and `load_environment`; the maps are small for their lobes; or the environment is too
        coarse for the sharpest kernels, which are left out.
    """
    check_target(output, force)
    yield Progress(0, 1, "reading the environment")
    light = load_environment(environment, clamp)
    brdf = yield from load_brdf(spec)
    fit = yield from _resolved_fit(brdf, fitting, light)
    return (yield from _baked(light, fit, settings, output, force))


def bake_fit(
    environment: str | None,
    fit: Path,
    settings: StackSettings,
    output: Path,
    force: bool = False,
    clamp: float | None = None,
) -> Steps[BakedStack]:
    """Filter an environment with the lobes of a fit that was made before.

    Parameters
    ----------
    environment : str or None
        As in `bake_brdf`.
    fit : Path
        What `tasks.reflectance.fit_lobes` wrote.
    settings, output, force, clamp
        As in `bake_brdf`.

    Yields
    ------
    Progress

    Returns
    -------
    BakedStack

    Raises
    ------
    InputFileError, OutputFileError, SceneError, RenderError
    RangeError
        A lobe is narrower than the environment resolves, light too bright for half floats, or the maps too
        large for this machine's memory.

    Warns
    -----
    RsibrWarning
        See `load_environment`; or the maps are small for their lobes.
    """
    check_target(output, force)
    yield Progress(0, 1, "reading the environment")
    return (yield from _baked(load_environment(environment, clamp), read_fit(fit), settings, output, force))


def _resolved_fit(brdf: Brdf, fitting: FitSettings, light: Environment) -> Steps[Fit]:
    """A fit with the kernels that the environment resolves, and a warning where sharper ones would serve."""
    fit = yield from METHODS[fitting.method](brdf, fitting)
    height, width = light.radiance.shape[:2]
    resolved, sharpest = sharpest_resolved(height), fit.bank.kappa[fit.used].max(initial=0.0)
    if sharpest <= resolved:
        return fit
    coarser = yield from METHODS[fitting.method](brdf, replace(fitting, sharpest=resolved))
    yield Progress(0, 1, "measuring the fits")
    without, with_sharper = (fit_errors(each, brdf).error for each in (coarser, fit))
    enough = next(2**n for n in count(1) if sharpest_resolved(height * 2**n) >= sharpest)
    warnings.warn(
        f"{light.name} is too coarse, at {width}x{height}, for the sharpest kernels of these lobes: without "
        f"them E is {without:.3g}, with them {with_sharper:.3g}; one of {enough * width}x{enough * height} "
        f"takes them.",
        RsibrWarning,
        stacklevel=2,
    )
    return coarser


def _baked(
    light: Environment, fit: Fit, settings: StackSettings, output: Path, force: bool
) -> Steps[BakedStack]:
    def afford(needed: float, size: int) -> None:
        check_memory(needed, str(output), (size, size), BYTES_BESIDES)

    baked = yield from bake_stack(light.radiance, fit, settings.layout, settings.size, afford)
    size = baked.filtered.size
    if baked.interpolation > TOLD_INTERPOLATION:
        warnings.warn(
            f"Lookups in maps of {size} texels cost about {100.0 * baked.interpolation:.2g} %: choose "
            f"a larger size.",
            RsibrWarning,
            stacklevel=2,
        )
    stated = {"layout": settings.layout, "size": size, "half": settings.half}
    yield Progress(0, 1, f"writing {output.name}")
    write_map_set(output, in_turn(baked, light, stated, software()), force, settings.half)
    return baked
