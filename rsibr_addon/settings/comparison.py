"""What is compared with the truth, whatever the kind of map set."""

from dataclasses import dataclass, field, fields, replace
from typing import Any

from ..core.errors import RangeError
from ..core.options import OPTION, option
from .drawing import SceneOptions


def samples_option() -> Any:
    """How well Cycles renders references."""
    return option(
        64,
        label="Samples",
        help="Samples of Cycles for a pixel, half of them in each of two renders, which tell the noise",
        least=4,
        most=1 << 24,
    )


def cycles_material_option() -> Any:
    """What Cycles renders where it is to tell the truth."""
    return option(
        None,
        label="Material",
        help="Compare with this material of Cycles' instead of the model itself",
        none="the model itself",
        metavar="PRESET|FILE.blend:NAME",
    )


def option_of_look(look: Any, name: str, **changes: Any) -> Any:
    """An option that a comparison has as a look has it.

    Parameters
    ----------
    look : type
    name : str
        Of the look's field.
    **changes
        Attributes of `core.options.Option` that differ.
    """
    like = next(each for each in fields(look) if each.name == name)
    told = replace(like.metadata[OPTION], **changes)
    return field(default=like.default, metadata={OPTION: told})


@dataclass(frozen=True, kw_only=True)
class ComparisonOptions(SceneOptions):
    """What is seen in a comparison, and from where."""

    size: int = option(
        128, label="Size", help="Width and height of a picture", unit="pixels", least=1, most=1024
    )
    views: int = option(
        30,
        label="Views",
        help="View directions, random and evenly distributed over the sphere",
        least=1,
        most=2**16,
    )
    seed: int = option(0, label="Seed", help="Seed of all random numbers", least=0)


@dataclass(frozen=True, kw_only=True)
class ExactComparison(ComparisonOptions):
    """How maps are compared with a reflectance model itself."""

    rings: int | None = option(
        None,
        label="Rings",
        help="Rings of a sphere on which reflection is integrated exactly",
        least=4,
        none="as the highlights are fine",
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.perspective is not None:
            raise RangeError("Exact references are orthographic: leave the perspective out.")
