"""What a comparison found: plain data, and a table of several."""

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from statistics import median
from typing import Any, Self

from ..core.errors import RangeError
from ..core.shading.radiance_views import Mode, Warping

LARGEST = 1024
"""Width and height of the largest picture to compare."""


@dataclass(frozen=True)
class ComparisonSettings:
    """What to render with Cycles, and which ways of drawing to hold against it.

    Attributes
    ----------
    views : int
        How many view directions, at least 1, evenly distributed at random over the sphere.
    seed : int
        Of the directions and of Cycles' noise.
    mesh : str
        As `host.meshes.load_mesh` takes it.
    field_of_view : float or None
        Of a perspective camera, in radians; None for orthographic.
    size : int
        Width and height of each picture in pixels, at most `LARGEST`.
    samples : int
        Cycles' samples a pixel, at least 4: two renders of half as many each tell the noise.
    modes : tuple of Mode
    warpings : tuple of Warping
    captured_views : tuple of int
        Draw also from the first 12 or 42 captured views alone; empty for all of them.

    Raises
    ------
    RangeError
        There are no views, too few samples, or `size` is too large.
    """

    views: int = 30
    seed: int = 0
    mesh: str = "sphere"
    field_of_view: float | None = None
    size: int = 128
    samples: int = 64
    modes: tuple[Mode, ...] = tuple(Mode)
    warpings: tuple[Warping, ...] = tuple(Warping)
    captured_views: tuple[int, ...] = ()

    def __post_init__(self) -> None:
        if self.views < 1:
            raise RangeError(f"A comparison of {self.views} views compares nothing: ask for 1 or more.")
        if self.samples < 4:
            raise RangeError("Two renders tell the noise of a reference: ask for 4 samples or more.")
        if self.size > LARGEST:
            raise RangeError(f"A comparison cannot be {self.size} pixels wide: choose at most {LARGEST}.")


@dataclass(frozen=True)
class Way:
    """One way to draw a map set.

    Attributes
    ----------
    captured_views : int
        How many views it blends from.
    mode : Mode
    warping : Warping
    """

    captured_views: int
    mode: Mode
    warping: Warping

    @property
    def slug(self) -> str:
        """A name for files and pages: 12-fragment-split."""
        return f"{self.captured_views}-{self.mode}-{self.warping}"


@dataclass(frozen=True)
class WayError:
    """Relative RMSE of one way to draw, see `core.metrics.relative_rmse_beyond_noise`.

    Attributes
    ----------
    way : Way
    per_view : tuple of float
        Of each view alone.
    pooled : float
        Of all views as one picture.
    """

    way: Way
    per_view: tuple[float, ...]
    pooled: float

    @property
    def median(self) -> float:
        """Of the views' errors."""
        return median(self.per_view)

    @property
    def worst(self) -> float:
        """The largest of the views' errors."""
        return max(self.per_view)


@dataclass(frozen=True)
class Comparison:
    """How far pictures drawn from a map set are from Cycles' own.

    Attributes
    ----------
    map_set, environment, material : str
        What a person calls them.
    map_size : int
        Width and height of the captured maps in texels.
    settings : ComparisonSettings
    view_dirs : tuple
        Unit vector to the eye of each view.
    reference_noise : float
        Relative RMSE that Cycles' own noise alone leaves in the reference: an error much smaller
        than it cannot be told.
    errors : tuple of WayError
    """

    map_set: str
    environment: str
    material: str
    map_size: int
    settings: ComparisonSettings
    view_dirs: tuple[tuple[float, float, float], ...]
    reference_noise: float
    errors: tuple[WayError, ...] = field(repr=False)

    def to_json(self) -> dict[str, Any]:
        """Everything as JSON values, with the median and the worst of each way."""
        plain = asdict(self)
        plain["errors"] = [
            {
                **asdict(error.way),
                "pooled": error.pooled,
                "median": error.median,
                "worst": error.worst,
                "per_view": list(error.per_view),
            }
            for error in self.errors
        ]
        return plain

    @classmethod
    def from_json(cls, plain: dict[str, Any]) -> Self:
        """The inverse of `to_json`, also after a round through JSON text."""
        settings = {
            name: tuple(value) if isinstance(value, list) else value
            for name, value in plain["settings"].items()
        }
        settings["modes"] = tuple(Mode(mode) for mode in settings["modes"])
        settings["warpings"] = tuple(Warping(warping) for warping in settings["warpings"])
        errors = tuple(
            WayError(
                Way(each["captured_views"], Mode(each["mode"]), Warping(each["warping"])),
                tuple(each["per_view"]),
                each["pooled"],
            )
            for each in plain["errors"]
        )
        view_dirs = tuple(tuple(view_dir) for view_dir in plain["view_dirs"])
        return cls(
            **{
                **plain,
                "settings": ComparisonSettings(**settings),
                "view_dirs": view_dirs,
                "errors": errors,
            }
        )


def comparison_table(comparisons: Sequence[Comparison]) -> str:
    """Pooled errors of several comparisons as a table in Markdown.

    Parameters
    ----------
    comparisons : sequence of Comparison
        With the same ways of drawing, whatever the numbers of captured views.

    Returns
    -------
    str
        A row for each material, environment and number of captured views, in the order given; a
        column for each mode and warp, and one for the noise of the references.
    """
    columns = list(dict.fromkeys((e.way.mode, e.way.warping) for c in comparisons for e in c.errors))
    head = ["material", "environment", "views", *(f"{mode}, {warping}" for mode, warping in columns), "noise"]
    rows = [head, ["---"] * 3 + ["---:"] * (len(columns) + 1)]
    for comparison in comparisons:
        pooled = {(e.way.captured_views, e.way.mode, e.way.warping): e.pooled for e in comparison.errors}
        for captured_views in dict.fromkeys(way[0] for way in pooled):
            errors = (pooled.get((captured_views, *column), math.nan) for column in columns)
            numbers = [f"{number:.3f}" for number in (*errors, comparison.reference_noise)]
            rows.append([comparison.material, comparison.environment, str(captured_views), *numbers])
    return "".join(f"| {' | '.join(row)} |\n" for row in rows)
