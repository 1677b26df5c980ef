"""Results of a comparison: plain data."""

import math
from collections.abc import Callable
from dataclasses import asdict, dataclass, field
from statistics import median
from typing import Annotated, Any, Protocol, TypedDict

import numpy as np

from ...core.conventions import Array
from ...core.errors import RangeError, SchemaError
from ...core.geometry.camera import Camera
from ...core.geometry.directions import normalize
from ...core.schema import Rule, between, decode, length
from ...files.map_set_header import WIDEST
from ...settings.comparison import ComparisonOptions

RESULT = "comparison.json"
"""The file by which a comparison's folder is known."""

MOST_VIEWS, MOST_WAYS = 2**16, 1024
"""Greatest numbers of views, and of ways to draw, that a comparison may have when it is read."""


class Way(Protocol):
    """A way to draw what a map set holds; a frozen dataclass, for each kind of map set its own.

    Attributes
    ----------
    slug : str
        A name for files and reports: 12-fragment-split.
    name : str
        A name for people.
    """

    @property
    def slug(self) -> str:
        """See above."""

    @property
    def name(self) -> str:
        """See above."""


@dataclass(frozen=True)
class WayError:
    """Relative RMSE of one way to draw, see `core.metrics`.

    Attributes
    ----------
    way : Way
    per_view : tuple of float
        Error of each view alone.
    pooled : float
        Error of all views as one picture.
    """

    way: Any
    per_view: tuple[float, ...]
    pooled: float

    @property
    def median(self) -> float:
        """Median of the views' errors."""
        return median(self.per_view)

    @property
    def worst(self) -> float:
        """The largest of the views' errors."""
        return max(self.per_view)


def way_error(way: Way, measure: Callable[..., float], *pictures: Array) -> WayError:
    """Measure a way to draw.

    Parameters
    ----------
    way : Way
    measure : callable
        Pictures, or several as one, to an error: a function of `core.metrics`.
    *pictures : ndarray, shape (views, ...)
        What `measure` takes, of all views; the last are weights. A view in which nothing counts, as that of
        a flat mesh from its edge, has the error 0.

    Raises
    ------
    RangeError
        Nothing counts in any view, or `measure` raises it.
    """
    if not np.any(pictures[-1]):
        raise RangeError(
            "The views show nothing of the mesh, as of a flat one from its edge: give a larger size or more "
            "views."
        )
    views = zip(*pictures, strict=True)
    per_view = tuple(measure(*each) if np.any(each[-1]) else 0.0 for each in views)
    return WayError(way, per_view, pooled=measure(*pictures))


@dataclass(frozen=True)
class Comparison:
    """How far pictures drawn from a map set are from what they should be.

    Attributes
    ----------
    map_set, environment, material : str
        What a person calls them.
    content : str
        What the map set held: see `files.map_set_header.content_hash`.
    map_size : int
        Width and height of the maps in texels.
    settings : ComparisonOptions
        Settings of the kind of map set.
    view_dirs : tuple
        Unit vector to the eye of each view.
    reference_noise : float
        Relative RMSE that Cycles' own noise alone leaves in the reference: an error much smaller
        than it cannot be told. 0 where the reference is exact.
    errors : tuple of WayError
    """

    map_set: str
    content: str
    environment: str
    material: str
    map_size: int
    settings: Any
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

    @staticmethod
    def from_json(plain: Any, settings: type, way: type) -> "Comparison":
        """The inverse of `to_json`, also after a round through JSON text.

        Parameters
        ----------
        plain : object
        settings, way : type
            The kind of the settings and the ways to draw: see `truth.Truth`.

        Raises
        ------
        SchemaError
            It is no comparison, or one of another version.
        """
        told: dict[str, Any] = {**decode(_File, plain)}
        return Comparison(
            **{name: told[name] for name in ("map_set", "content", "environment", "material", "map_size")},
            settings=decode(settings, _with_perspective(told["settings"]), "settings"),
            view_dirs=decode(tuple[tuple[float, float, float], ...], told["view_dirs"], "view_dirs"),
            reference_noise=told["reference_noise"],
            errors=tuple(_way_error(way, each, len(told["view_dirs"])) for each in told["errors"]),
        )


_NotNegative = Annotated[float, Rule("a number from 0", lambda value: value >= 0.0)]


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


def _with_perspective(told: dict[str, Any]) -> dict[str, Any]:
    """Settings as they are now; version 0.1 wrote the angle of view in radians."""
    now = {name: value for name, value in told.items() if name != "field_of_view"}
    angle = told.get("field_of_view")
    return (
        now if angle is None else now | {"perspective": math.degrees(decode(float, angle, "field_of_view"))}
    )


def _way_error(way: type, told: _Error, views: int) -> WayError:
    plain = {name: value for name, value in told.items() if name not in _Error.__annotations__}
    if len(told["per_view"]) != views:
        raise SchemaError(f"errors are of {len(told['per_view'])} views, not {views}")
    return WayError(decode(way, plain, "errors"), tuple(told["per_view"]), told["pooled"])


def cameras_of(settings: ComparisonOptions) -> list[Camera]:
    """The camera of each view of a comparison."""
    directions = random_directions(settings.views, settings.seed).tolist()
    return [settings.camera((x, y, z)) for x, y, z in directions]


def random_directions(count: int, seed: int) -> Array:
    """Directions that are equally likely everywhere on the sphere.

    Returns
    -------
    ndarray, shape (count, 3), float64
        Unit vectors; the first of more are the same as fewer.
    """
    # Normal distributions along three axes favour no direction.
    return normalize(np.random.default_rng(seed).standard_normal((count, 3)))
