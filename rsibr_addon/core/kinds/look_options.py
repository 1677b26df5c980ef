"""Options that the looks of several kinds have."""

from typing import Any

from ..antialiased.averaging import Averaging
from ..options import Choice, option


def colour_option(default: float, label: str, help: str, old_name: str, metavar: str = "F|R,G,B") -> Any:
    """A share of light, in [0, 1] for red, green and blue; `default` is of all three, `old_name` of 0.1."""
    return option(
        (default,) * 3,
        label=label,
        help=help,
        least=0.0,
        most=1.0,
        subtype="COLOR",
        metavar=metavar,
        old_flag=f"--{old_name.replace('_', '-')}",
        stored=old_name,
    )


def antialiased_option(light: str, default: bool = True) -> Any:
    """Whether a kind of light is averaged over pixels."""
    return option(
        default,
        label="Antialiased",
        help=f"Average {light} over what each pixel reflects, so that small lamps do not shimmer",
    )


def averaging_option() -> Any:
    """How a table is averaged over pixels."""
    return option(
        Averaging.SUBDIVIDE,
        label="Averaged By",
        help="How a table is averaged over what a pixel reflects, if it is antialiased",
        choices={
            Averaging.SUBDIVIDE: Choice("Subdivision", "a lookup for each texel, or boxes if too many"),
            Averaging.QUADRILATERAL: Choice(
                "Quadrilateral", "the area between a pixel's corners, row by row"
            ),
            Averaging.SUMMED: Choice("Summed Area", "boxes of a summed table, at a constant cost"),
        },
        advanced=True,
        flag="--antialiased-by",
    )
