"""Captures that go on: more views, each where it tells lobes that are fitted to them most."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...core.conventions import Array
from ...core.counted import counted
from ...core.environment import Environment
from ...core.geometry.view_sphere import MOST_VIEWS
from ...core.lobes.captures import CapturedFit, fit_captures
from ...core.lobes.next_views import next_views
from ...core.progress import Progress, Steps
from ...core.warned import warn
from ...settings.radiance_views import RadianceViewsSettings
from .fit_captures import filtered_light, is_reached, shipped_families
from .kept_views import KeptViews

AT_ONCE = 4
"""Most views that are chosen of one fit: a fit takes longer than they do."""

Capture = Callable[[Array, Sequence[int]], Steps[None]]
"""Captures some of the views of the directions given, by their numbers."""


@dataclass(frozen=True)
class CapturedViews:
    """Which views were captured, and what they tell.

    Attributes
    ----------
    view_dirs : ndarray, shape (V, 3)
        The chosen ones last.
    chosen : int
        How many were chosen.
    left_out : float or None
        See `Fit.left_out`, of lobes fitted to all views; None where none were, or for fewer than
        `captures.FEWEST_VIEWS` views.
    untested : float or None
        See `CapturedFit`.
    """

    view_dirs: Array
    chosen: int = 0
    left_out: float | None = None
    untested: float | None = None

    def report(self) -> tuple[str, dict[str, Any]]:
        """What was captured, in words that follow the number of views, and as JSON values."""
        figures: dict[str, Any] = {"views": len(self.view_dirs)}
        if self.left_out is None or self.untested is None:
            return "", figures
        words = (
            f", {self.chosen} of them chosen; error of lobes in views left out {self.left_out:.2g}, "
            f"{self.untested:.0%} of new views untested"
        )
        told = {"chosen": self.chosen, "left_out": self.left_out, "untested": self.untested}
        return words, {**figures, **told}


def most_views(settings: RadianceViewsSettings, count: int) -> int:
    """How many views are captured at most, of which `count` are asked for by direction."""
    return max(count, min(count + (settings.more_views or 0), MOST_VIEWS))


def capture_views(
    settings: RadianceViewsSettings, light: Environment, view_dirs: Array, kept: KeptViews, capture: Capture
) -> Steps[CapturedViews]:
    """Capture the views asked for, and as many more as settings say.

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
    RangeError
        More views are asked for, but those there are black, or the light resolves no kernel.
    Or see `capture`.

    Warns
    -----
    RsibrWarning
        The goal is not reached.
    """
    most = most_views(settings, len(view_dirs))
    asked, every = len(view_dirs), np.concatenate([view_dirs, kept.chosen()])
    yield from capture(every, kept.missing(len(every)))
    if settings.more_views is None:
        return CapturedViews(every)
    filtered = filtered_light(light.radiance)
    while True:
        fitted = yield from _within(
            Progress(len(every), most, f"fitting lobes to {counted(len(every), 'view')}"),
            fit_captures(kept.read(every), filtered, shipped_families(), settings.material),
        )
        left_out, room = fitted.fit.left_out, min(AT_ONCE, most - len(every))
        if room <= 0 or is_reached(settings.goal, left_out):
            break
        more = next_views(every, settings.size, filtered, fitted.weighed, room)
        if not len(more):
            break
        every = np.concatenate([every, more])
        kept.choose(every[asked:])
        yield from capture(every, kept.missing(len(every)))
    if settings.goal is not None and not is_reached(settings.goal, left_out):
        known = "say nothing of" if left_out is None else f"have an error of {left_out:.2g} in"
        warn(
            f"Lobes fitted to {counted(len(every), 'view')} {known} views that are left out, and the goal is "
            f"{settings.goal:g}: allow more views, or fit with this goal, by rsibr fit --captures --goal, "
            "which turns to the material itself."
        )
    return CapturedViews(every, len(every) - asked, left_out, fitted.untested)


def _within(place: Progress, steps: Steps[CapturedFit]) -> Steps[CapturedFit]:
    """Steps of other work as one of this."""
    while True:
        try:
            next(steps)
        except StopIteration as end:
            fitted: CapturedFit = end.value
            return fitted
        yield place
