"""What is compared with the truth, whatever the kind of map set."""

from dataclasses import dataclass

from ..core.errors import RangeError
from ..core.options import option
from .drawing import SceneOptions


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
