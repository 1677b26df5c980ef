"""What lies behind an object in a picture."""

from dataclasses import dataclass

from ..core.errors import RangeError
from ..core.options import Options, option
from .light import exposure_option

LIGHT = "light"
"""The background that is the map set's own light."""


@dataclass(frozen=True, kw_only=True)
class BackgroundOptions(Options):
    """How a background is shown."""

    background_blur: float = option(
        0.0,
        label="Blur",
        help="How blurred the light behind the object is",
        unit="degrees",
        least=0.0,
        most=90.0,
        flag="--background-blur",
        metavar="DEG",
    )
    background_exposure: float = exposure_option(
        0.0, "How much brighter the background is", flag="--background-exposure"
    )


@dataclass(frozen=True, kw_only=True)
class MatteOptions(BackgroundOptions):
    """The background, and a floor that takes the object's shadow.

    Raises
    ------
    RangeError
        A value is out of range, or there is no background to blur or expose.
    """

    background: str | None = option(
        None,
        label="Background",
        help=f"What is behind the object: {LIGHT} for the map set's own light, or a picture, whose middle "
        "fills the frame",
        none="nothing",
        none_as="",
        metavar=f"{LIGHT}|PICTURE",
    )
    floor: bool = option(
        False,
        label="Floor",
        help="A floor below the object takes its diffuse shadow, on the background or alone",
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.background != LIGHT and self.background_blur:
            raise RangeError("Only light can be blurred: choose light as the background, or no blur.")
        if self.background is None and self.background_exposure:
            raise RangeError("There is no background to expose: choose one, or leave its exposure out.")
