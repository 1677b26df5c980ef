"""What a comparison found: plain data, and a table of several."""

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from statistics import median
from typing import Annotated, Any, TypedDict

import numpy as np

from ...core.conventions import Array
from ...core.errors import RangeError, SchemaError
from ...core.geometry.camera import Camera
from ...core.geometry.directions import normalize
from ...core.kinds.radiance_views.shading import Mode, Warping
from ...core.schema import Rule, between, decode, length
from ...files.map_set_header import WIDEST

RESULT = "comparison.json"
"""The file by which a comparison's folder is known."""

LARGEST = 1024
"""Width and height of the largest picture to compare."""

MOST_VIEWS, MOST_WAYS = 2**16, 1024
"""Of a comparison that is read."""


@dataclass(frozen=True)
class SceneSettings:
    """What is seen in a comparison, from where, and how large.

    Attributes
    ----------
    views : int
        How many view directions, at least 1, evenly distributed at random over the sphere.
    seed : int
        Of everything random.
    mesh : str
        As `host.meshes.load_mesh` takes it.
    field_of_view : float or None
        Of a perspective camera, in radians; None for orthographic.
    size : int
        Width and height of each picture in pixels, at most `LARGEST`.

    Raises
    ------
    RangeError
        There are no views, or `size` is too large.
    """

    views: int = 30
    seed: int = 0
    mesh: str = "sphere"
    field_of_view: float | None = None
    size: int = 128

    def __post_init__(self) -> None:
        if self.views < 1:
            raise RangeError(f"A comparison of {self.views} views compares nothing: ask for 1 or more.")
        if self.size > LARGEST:
            raise RangeError(f"A comparison cannot be {self.size} pixels wide: choose at most {LARGEST}.")

    @property
    def cameras(self) -> list[Camera]:
        """One for each view."""
        directions = random_directions(self.views, self.seed).tolist()
        return [Camera((x, y, z), self.field_of_view) for x, y, z in directions]


@dataclass(frozen=True)
class ComparisonSettings(SceneSettings):
    """What to render with Cycles, and which ways of drawing radiance views to hold against it.

    Attributes
    ----------
    samples : int
        Cycles' samples a pixel, at least 4: two renders of half as many each tell the noise.
    modes : tuple of Mode
    warpings : tuple of Warping
    captured_views : tuple of int
        Draw also from the first 12 or 42 captured views alone; empty for all of them.

    Raises
    ------
    RangeError
        Too few samples, or as `SceneSettings`.
    """

    samples: int = 64
    modes: tuple[Mode, ...] = tuple(Mode)
    warpings: tuple[Warping, ...] = tuple(Warping)
    captured_views: tuple[int, ...] = ()

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.samples < 4:
            raise RangeError("Two renders tell the noise of a reference: ask for 4 samples or more.")


@dataclass(frozen=True)
class StackComparisonSettings(SceneSettings):
    """What to light exactly, and to hold a lobe stack against.

    Attributes
    ----------
    rings : int or None
        Of `core.geometry.lit_sphere`, at least 4; None for half as many as a map has texels in a row, at
        least 32.

    Raises
    ------
    RangeError
        The camera is a perspective one, there are too few rings, or as `SceneSettings`.
    """

    rings: int | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.field_of_view is not None:
            raise RangeError("Exact references are seen from afar: leave the perspective out.")
        if self.rings is not None and self.rings < 4:
            raise RangeError(f"{self.rings} rings are too few to interpolate between: ask for 4 or more.")


@dataclass(frozen=True)
class Way:
    """One way to draw radiance views.

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

    @property
    def name(self) -> str:
        """A name for people."""
        return f"{self.captured_views} views, {self.mode}, {self.warping} warp"


@dataclass(frozen=True)
class StackWay:
    """The way to draw a lobe stack: there is one.

    Attributes
    ----------
    lobes, elevations, taps : int
        How many there are.
    """

    lobes: int
    elevations: int
    taps: int

    @property
    def slug(self) -> str:
        """A name for files and pages: 3-lobes."""
        return f"{self.lobes}-lobes"

    @property
    def name(self) -> str:
        """A name for people."""
        return f"lobes: {self.lobes}, elevations: {self.elevations}, taps: {self.taps}"


@dataclass(frozen=True)
class WayError[W: Way | StackWay = Way | StackWay]:
    """Relative RMSE of one way to draw, see `core.metrics`.

    Attributes
    ----------
    way : Way or StackWay
    per_view : tuple of float
        Of each view alone.
    pooled : float
        Of all views as one picture.
    """

    way: W
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
class Comparison[W: Way | StackWay = Way | StackWay]:
    """How far pictures drawn from a map set are from what they should be.

    Attributes
    ----------
    map_set, environment, material : str
        What a person calls them.
    content : str
        What the map set held: see `files.map_set_header.content_hash`.
    map_size : int
        Width and height of the maps in texels.
    settings : ComparisonSettings or StackComparisonSettings
    view_dirs : tuple
        Unit vector to the eye of each view.
    reference_noise : float
        Relative RMSE that Cycles' own noise alone leaves in the reference: an error much smaller
        than it cannot be told. 0 where the reference is exact.
    errors : tuple of WayError
        Of a `Way` each where Cycles rendered the reference, of a `StackWay` where it is exact.
    """

    map_set: str
    content: str
    environment: str
    material: str
    map_size: int
    settings: ComparisonSettings | StackComparisonSettings
    view_dirs: tuple[tuple[float, float, float], ...]
    reference_noise: float
    errors: tuple[WayError[W], ...] = field(repr=False)

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

    @staticmethod
    def from_json(plain: Any) -> "Comparison":
        """The inverse of `to_json`, also after a round through JSON text.

        Raises
        ------
        SchemaError
            It is no comparison, or one of another version.
        """
        told: dict[str, Any] = {**decode(_File, plain)}
        return Comparison(
            **{name: told[name] for name in ("map_set", "content", "environment", "material", "map_size")},
            settings=decode(ComparisonSettings | StackComparisonSettings, told["settings"], "settings"),
            view_dirs=decode(tuple[tuple[float, float, float], ...], told["view_dirs"], "view_dirs"),
            reference_noise=told["reference_noise"],
            errors=tuple(_way_error(each, len(told["view_dirs"])) for each in told["errors"]),
        )


type _NotNegative = Annotated[float, Rule("a number from 0", lambda value: value >= 0.0)]


class _Error(TypedDict):
    per_view: Annotated[list[_NotNegative], length(1, MOST_VIEWS)]
    pooled: _NotNegative
    median: _NotNegative
    worst: _NotNegative


class _File(TypedDict):
    map_set: str
    content: str
    environment: str
    material: str
    map_size: Annotated[int, between(1, WIDEST)]
    settings: dict[str, Any]
    view_dirs: Annotated[list[Any], length(1, MOST_VIEWS)]
    reference_noise: _NotNegative
    errors: Annotated[list[_Error], length(1, MOST_WAYS)]


def _way_error(told: _Error, views: int) -> WayError:
    way = {name: value for name, value in told.items() if name not in _Error.__annotations__}
    if len(told["per_view"]) != views:
        raise SchemaError(f"errors are of {len(told['per_view'])} views, not {views}")
    return WayError(decode(Way | StackWay, way, "errors"), tuple(told["per_view"]), told["pooled"])


def random_directions(count: int, seed: int) -> Array:
    """Directions that are equally likely everywhere on the sphere.

    Parameters
    ----------
    count, seed : int

    Returns
    -------
    ndarray, shape (count, 3), float64
        Unit vectors; the first of more are the same as fewer.
    """
    # Normal distributions along three axes favour no direction.
    return normalize(np.random.default_rng(seed).standard_normal((count, 3)))


def comparison_table(comparisons: Sequence[Comparison[Way]]) -> str:
    """Pooled errors of several comparisons of radiance views as a table in Markdown.

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


def stack_table(comparisons: Sequence[Comparison[StackWay]]) -> str:
    """Errors of several comparisons of lobe stacks as a table in Markdown.

    Parameters
    ----------
    comparisons : sequence of Comparison

    Returns
    -------
    str
        A row for each.
    """
    head = ["BRDF", "environment", "lobes", "size", "all views", "median view", "worst view"]
    rows = [head, ["---"] * 2 + ["---:"] * 5]
    for comparison in comparisons:
        (error,) = comparison.errors
        numbers = [f"{number:.4f}" for number in (error.pooled, error.median, error.worst)]
        maps = [str(error.way.lobes), str(comparison.map_size)]
        rows.append([comparison.material, comparison.environment, *maps, *numbers])
    return "".join(f"| {' | '.join(row)} |\n" for row in rows)
