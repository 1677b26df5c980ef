"""References for pictures drawn from map sets of a kind."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from ...core.conventions import Array
from ...core.environment import Environment
from ...core.progress import Steps
from ...settings.comparison import ComparisonOptions
from .comparison import Comparison, Way, WayError


@dataclass(frozen=True, eq=False)
class Drawn:
    """The pictures of a comparison, each of shape (size, size, 4): radiance times coverage, and coverage.

    Attributes
    ----------
    material : str
        What counts as true, in words.
    map_size : int
        Width and height of the maps in texels.
    settings : ComparisonOptions
        With all that they left open.
    references : list of ndarray
        The truth, of each view; row 0 at the bottom.
    drawn : dict of Way to list of ndarray
        The same views from the map set.
    errors : tuple of WayError
        In the order of `drawn`.
    noise : float
        See `Comparison.reference_noise`.
    """

    material: str
    map_size: int
    settings: ComparisonOptions
    references: list[Array]
    drawn: dict[Any, list[Array]]
    errors: tuple[WayError, ...]
    noise: float = 0.0


@dataclass(frozen=True)
class Telling:
    """What is told of references.

    Attributes
    ----------
    name : str
        Who tells the truth: "Cycles".
    made : str
        How: "rendered by Cycles".
    quality : str
        How good they are, in words.
    notes : callable
        A comparison to what else there is to know of its references, as HTML.
    """

    name: str
    made: str
    quality: str
    notes: Callable[[Comparison], str]


@dataclass(frozen=True)
class Truth:
    """How map sets of a kind are compared.

    Attributes
    ----------
    way : type
        A dataclass that is a `Way`.
    draw : callable
        The map set's file, for messages; its content, environment and material; and settings, to `Drawn`.
    telling : callable
        Settings, with all that they left open, to what is told of the references.
    is_look : callable
        Whether a way to draw is that of a look.
    """

    way: type[Way]
    draw: Callable[[Any, Any, Environment, dict[str, Any], Any], Steps[Drawn]]
    telling: Callable[[Any], Telling]
    is_look: Callable[[Any, Any], bool] = lambda way, look: True
