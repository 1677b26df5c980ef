"""How a map of light is laid out in another representation."""

from dataclasses import dataclass

from ..core.errors import RangeError
from ..core.options import Options, option
from .environment import LARGEST, LAYOUTS
from .light import Clamp
from .photographs import BallDistance

PARAMETERS = {"overscan": "dual_paraboloid", "distance": "mirror_ball"}
"""Parameter -> the layout that it belongs to."""


@dataclass(frozen=True, kw_only=True)
class SourceLayout(Options):
    """The layout of a map that is there."""

    source_layout: str = option(
        label="From",
        help="Layout of IN",
        choices=LAYOUTS,
        start="angular_map",
        flag="--from",
        metavar="LAYOUT",
    )


@dataclass(frozen=True, kw_only=True)
class ConvertSettings(SourceLayout, BallDistance, Clamp):
    """The layouts of a map before and after."""

    target_layout: str = option(
        label="To", help="Layout of OUT", choices=LAYOUTS, flag="--to", metavar="LAYOUT"
    )
    size: int = option(
        label="Size",
        help="Width of OUT, or of each of its faces or sheets; equirect, of even width, is half as high",
        unit="texels",
        least=1,
        most=LARGEST,
    )
    overscan: float | None = option(
        None,
        label="Overscan",
        help="Half-width of a dual_paraboloid's sheets in radii of the hemisphere",
        least=1.0,
        most=1e3,
        none="1",
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        for name, owner in PARAMETERS.items():
            if getattr(self, name) is not None and owner not in (self.source_layout, self.target_layout):
                raise RangeError(f"Neither map is a {owner}, so there is nothing for {name}: leave it out.")

    def parameters(self, layout: str) -> dict[str, float]:
        """The parameters of a layout that are given."""
        given = {name: getattr(self, name) for name, owner in PARAMETERS.items() if owner == layout}
        return {name: value for name, value in given.items() if value is not None}
