"""An environment and a reflectance model, or its fit, to a lobe stack, in a map set."""

import warnings
from dataclasses import dataclass
from pathlib import Path

from ..core.errors import RsibrWarning
from ..core.lobes.bake import BakedStack, bake_stack
from ..core.lobes.fit import Fit
from ..core.lobes.stack import LAYOUTS, stack_representation
from ..core.progress import Progress, Steps
from ..files.atomic import check_target
from ..files.fits import read_fit
from ..files.kinds.lobe_stack import PROFILES, profiles, to_map_set
from ..files.map_set import write_map_set
from ..host.version import software
from .brdfs import load_brdf
from .environments import load_environment
from .fit_lobes import METHODS, FitSettings

TOLD_INTERPOLATION = 0.01
"""Relative error that lookups may be expected to cost before somebody is told."""


@dataclass(frozen=True)
class StackSettings:
    """How maps are laid out and stored.

    Attributes
    ----------
    layout : str
        One of `core.lobes.stack.LAYOUTS`.
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
) -> Steps[BakedStack]:
    """Fit lobes to a model and filter an environment with them.

    Parameters
    ----------
    environment : str or None
        A latitude-longitude file, a name of one of Blender's own, or None for the open file's world:
        see `load_environment`.
    spec : str
        The model: see `tasks.brdfs.load_brdf`.
    fitting : FitSettings
    settings : StackSettings
    output : Path
        By custom NAME.rsibr.exr.
    force : bool
        Whether an existing file is replaced.

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
        The text describes no model; a lobe is narrower than the environment resolves, or light too bright
        for half floats.

    Warns
    -----
    RsibrWarning
        See `load_brdf` and `load_environment`; or the maps are small for their lobes.
    """
    check_target(output, force)
    brdf = yield from load_brdf(spec)
    fit = yield from METHODS[fitting.method](brdf, fitting)
    return (yield from _baked(environment, fit, settings, output, force))


def bake_fit(
    environment: str | None, fit: Path, settings: StackSettings, output: Path, force: bool = False
) -> Steps[BakedStack]:
    """Filter an environment with the lobes of a fit that was made before.

    Parameters
    ----------
    environment : str or None
        As in `bake_brdf`.
    fit : Path
        What `tasks.fit_lobes` wrote.
    settings, output, force
        As in `bake_brdf`.

    Yields
    ------
    Progress

    Returns
    -------
    BakedStack

    Raises
    ------
    InputFileError, OutputFileError, SceneError, RenderError, RangeError

    Warns
    -----
    RsibrWarning
        As `bake_brdf`.
    """
    check_target(output, force)
    return (yield from _baked(environment, read_fit(fit), settings, output, force))


def _baked(
    environment: str | None, fit: Fit, settings: StackSettings, output: Path, force: bool
) -> Steps[BakedStack]:
    yield Progress(0, 1, "reading the environment")
    light = load_environment(environment)
    baked = yield from bake_stack(light.radiance, fit, settings.layout, settings.size)
    stack = baked.stack
    if baked.interpolation > TOLD_INTERPOLATION:
        warnings.warn(
            f"Lookups in maps of {stack.size} texels cost about {100.0 * baked.interpolation:.2g} %: choose "
            f"a larger size.",
            RsibrWarning,
            stacklevel=2,
        )
    map_set = to_map_set(
        stack,
        light,
        {"brdf": fit.brdf, "method": fit.method, PROFILES: profiles(fit)},
        {"filter": baked.bound.tolist(), "interpolation": baked.interpolation},
        {"layout": settings.layout, "size": stack.size, "half": settings.half},
        software(),
    )
    yield Progress(0, 1, f"writing {output.name}")
    write_map_set(output, map_set, force, settings.half)
    return baked
