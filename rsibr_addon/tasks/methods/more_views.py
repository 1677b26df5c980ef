"""Captures to which lobes are fitted, and which go on: more views, each where it tells the lobes most."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...core.brdf.spec import MATERIAL, is_model
from ...core.conventions import Array
from ...core.counted import counted
from ...core.environment import Environment
from ...core.errors import RangeError
from ...core.geometry.view_sphere import MOST_VIEWS
from ...core.lobes.captured_light import CapturedLight
from ...core.lobes.captures import METHOD, CapturedFit, fit_captures
from ...core.lobes.fit import Fit
from ...core.lobes.next_views import next_views
from ...core.progress import Progress, Steps
from ...core.warned import warn
from ...settings.radiance_views import RadianceViewsSettings
from ..reflectance.fit_views import fit_nearer_goal
from .fit_captures import Captures, filtered_light, is_reached, shipped_families
from .kept_views import KeptViews

AT_ONCE = 4
"""Most views that are chosen of one fit: a fit takes longer than they do."""

Capture = Callable[[Array, Sequence[int]], Steps[None]]
"""Captures some of the views of the directions given, by their numbers."""


@dataclass(frozen=True)
class CapturedViews:
    """Which views were captured, and the lobes that were fitted to them.

    Attributes
    ----------
    view_dirs : ndarray, shape (V, 3)
        The chosen ones last.
    chosen : int
        How many were chosen.
    fit : Fit or None
        To all views, or to the material itself; None where none was asked for.
    untested : float or None
        See `CapturedFit`; None of a fit to the material.
    """

    view_dirs: Array
    chosen: int = 0
    fit: Fit | None = None
    untested: float | None = None

    def report(self) -> tuple[str, dict[str, Any]]:
        """What was captured, in words that follow the number of views, and as JSON values."""
        figures: dict[str, Any] = {"views": len(self.view_dirs)}
        if self.fit is None:
            return "", figures
        source = "captures" if self.fit.method == METHOD else "material"
        left_out = self.fit.left_out
        words = f", {self.chosen} of them chosen" if self.chosen else ""
        words += "; lobes" if source == "captures" else "; lobes of the material itself"
        words += " of unknown error" if left_out is None else f", error in views left out {left_out:.2g}"
        if self.untested is not None:
            words += f", {self.untested:.0%} of new views untested"
        told = {"chosen": self.chosen, "source": source, "left_out": left_out, "untested": self.untested}
        return words, {**figures, **told}


def most_views(settings: RadianceViewsSettings, count: int) -> int:
    """How many views are captured at most, of which `count` are asked for by direction."""
    return max(count, min(count + (settings.more_views or 0), MOST_VIEWS))


def fitting_cost(asked: int, most: int) -> tuple[float, float]:
    """What fits to captured views take at most, measured with copper in 12 and in 42 views of 128 texels.

    Parameters
    ----------
    asked, most : int
        Number of views of the first fit, and of the last.

    Returns
    -------
    seconds : float
        Of the processor.
    memory : float
        Bytes, the views aside.
    """
    fits = 1 + -(-(most - asked) // AT_ONCE)
    return fits * (9.0 + 0.5 * most), 2.6e8 + 4e6 * most


def capture_views(
    settings: RadianceViewsSettings, light: Environment, view_dirs: Array, kept: KeptViews, capture: Capture
) -> Steps[CapturedViews]:
    """Capture the views asked for, and fit lobes to them and to as many more as settings say.

    Parameters
    ----------
    settings : RadianceViewsSettings
    light : Environment
        In which they are captured.
    view_dirs : ndarray, shape (V, 3)
        Those asked for.
    kept : KeptViews
        Views and choices of an earlier run are taken as they are.
    capture : callable
        See `Capture`; it hands the views to `kept`.

    Raises
    ------
    See `capture`.

    Warns
    -----
    RsibrWarning
        No lobes can be fitted: the views are black, or the light resolves no kernel; or see
        `fit_nearer_goal`.
    """
    every = np.concatenate([view_dirs, kept.chosen()])
    yield from capture(every, kept.missing(len(every)))
    if not settings.fits_lobes:
        return CapturedViews(every)
    asked, most = len(view_dirs), most_views(settings, len(view_dirs))
    try:
        filtered = filtered_light(light.radiance)
        found = yield from _fitted(settings, every, most, filtered, kept)
    except RangeError as error:
        warn(f"No lobes are fitted to the views: {error}")
        return CapturedViews(every, len(every) - asked)
    while len(every) < most and not is_reached(settings.goal, found.fit.left_out):
        room = min(AT_ONCE, most - len(every))
        more = next_views(every, settings.size, filtered, found.weighed, room)
        if not len(more):
            break
        every = np.concatenate([every, more])
        kept.choose(every[asked:])
        yield from capture(every, kept.missing(len(every)))
        found = yield from _fitted(settings, every, most, filtered, kept)
    if settings.goal is not None:
        spec = settings.material if is_model(settings.material) else f"{MATERIAL}:{settings.material}"
        captures = Captures(kept.read(every), light.radiance, spec, kept.noise(len(every)))
        closer = yield from fit_nearer_goal(settings.goal, found.fit, captures, spec)
        if closer is not None:
            return CapturedViews(every, len(every) - asked, closer.fit)
    return CapturedViews(every, len(every) - asked, found.fit, found.untested)


def _fitted(
    settings: RadianceViewsSettings, view_dirs: Array, most: int, light: CapturedLight, kept: KeptViews
) -> Steps[CapturedFit]:
    """Lobes of the views that there are, as one step of the capture."""
    count = len(view_dirs)
    steps = fit_captures(kept.read(view_dirs), light, shipped_families(), settings.material)
    while True:
        try:
            next(steps)
        except StopIteration as end:
            fitted: CapturedFit = end.value
            return fitted
        yield Progress(count, most, f"fitting lobes to {counted(count, 'view')}")
