"""What a kind of map sets is, with Blender."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from ...core.conventions import Array
from ...core.environment import Environment
from ...core.progress import Steps
from ...device.drawing import GpuMapSet
from ...files.map_set_data import MapSet
from ..compare.truth import Truth


@dataclass(frozen=True, eq=False)
class Figure:
    """Pictures that explain how a map set is shaded.

    Attributes
    ----------
    title, text : str
        For people.
    pictures : mapping of str to ndarray
        Caption -> radiance times coverage, and coverage, shape (size, size, 4); row 0 at the bottom.
    """

    title: str
    text: str
    pictures: Mapping[str, Array]


@dataclass(frozen=True)
class Kind:
    """What can be done with map sets of one kind.

    Attributes
    ----------
    drawable : callable
        The content of a map set to a `GpuMapSet`; of a live kind, the content and `LiveFits` or None to a
        `LiveGpuMapSet`.
    truth : Truth or None
        What pictures drawn from it are compared with; None for nothing.
    live : bool
        Whether its looks are made while one looks.
    by_sliders : callable or None
        Of a live kind: the environment and a look to a map set in memory and its look, which shade the same
        material and follow sliders; None for a look that cannot be had so.
    own : bool
        Whether its look has `own`, which asks for an object's own materials, and `antialiased`.
    menu : str
        A menu of Blender that its preview offers beside its look; empty for none.
    figure : callable or None
        The content to what a report shows of how it is shaded; None for nothing.
    """

    drawable: Callable[..., GpuMapSet]
    truth: Truth | None = None
    live: bool = False
    by_sliders: Callable[[Environment, Any], Steps[tuple[MapSet, Any] | None]] | None = None
    own: bool = False
    menu: str = ""
    figure: Callable[[Any], Figure] | None = None
