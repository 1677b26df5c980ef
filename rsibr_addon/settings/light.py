"""The light that is baked."""

from dataclasses import dataclass
from typing import Any

from ..core.environment import LARGEST
from ..core.errors import RangeError
from ..core.options import Choice, Options, option


@dataclass(frozen=True, kw_only=True)
class Clamp(Options):
    """How bright light may be."""

    clamp: float | None = option(
        None,
        label="Clamp",
        help="Greatest radiance: brighter and infinite values become this, and a warning counts them",
        least=1e-30,
        most=LARGEST,
        soft_most=1e5,
        none="infinite values become the greatest finite one",
        none_as=0.0,
        metavar="VALUE",
    )


@dataclass(frozen=True, kw_only=True)
class Light(Clamp):
    """Which light is baked, and how bright it may be."""

    environment: str | None = option(
        None,
        label="Environment",
        help="Latitude-longitude picture (EXR or HDR), or the name of one of Blender's own, such as forest",
        none="the world of the open file",
        none_as="",
        metavar="FILE",
    )
    bare_world: bool = option(
        False,
        label="Bare World",
        help="Bake the Environment Texture of the open file's world without rotation and strength, which "
        "previews add that follow the world",
        advanced=True,
    )


def card_option(where: str) -> Any:
    """Where a surface of known albedo is in a picture; `where` says in which."""
    return option(
        None,
        label="Grey Card",
        help="A grey card, or any surface of known albedo, which tells brightness and colour: middle and "
        f"radius of a circle on it, from the top left corner of {where}",
        unit="pixels",
        none="none",
        none_as=(0.0, 0.0, 0.0),
        once=True,
        metavar="X,Y,R",
    )


@dataclass(frozen=True, kw_only=True)
class LightColour(Options):
    """What is known of the colour and the brightness of light.

    Raises
    ------
    RangeError
        A value is out of range; or a card and a white balance both tell the colour.
    """

    white_balance: tuple[float, float, float] | None = option(
        None,
        label="White Balance",
        help="Colour in the picture that becomes grey, and stays as bright",
        least=1e-6,
        most=1e6,
        none="as it was taken",
        none_as=(0.0, 0.0, 0.0),
        once=True,
        metavar="R,G,B",
    )
    card: tuple[float, float, float] | None = card_option("what is written")
    albedo: tuple[float, float, float] = option(
        (0.18, 0.18, 0.18),
        label="Albedo",
        help="Albedo of the card; it will show just that, as under light of irradiance pi",
        least=1e-3,
        most=1.0,
        subtype="COLOR",
        metavar="F|R,G,B",
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.white_balance is not None and self.card is not None:
            raise RangeError("A card and a white balance both tell the colour of light: give one of them.")


def exposure_option(default: float | None, help: str, **more: Any) -> Any:
    """How much brighter something is made, in stops; `more` is told to `option`."""
    return option(
        default,
        label="Exposure",
        help=help,
        unit="stops",
        least=-32.0,
        most=32.0,
        soft_least=-10.0,
        soft_most=10.0,
        metavar="STOPS",
        **more,
    )


LIGHT_EXPOSURE = "How much brighter light is made than it was taken, or than a card makes it"


@dataclass(frozen=True, kw_only=True)
class KnownScale(LightColour):
    """How light is scaled whose brightness is known."""

    exposure: float | None = exposure_option(0.0, LIGHT_EXPOSURE)


@dataclass(frozen=True, kw_only=True)
class UnknownScale(LightColour):
    """How light is scaled that photographs do not tell the brightness of."""

    exposure: float | None = exposure_option(
        None,
        LIGHT_EXPOSURE,
        none="a white card that is turned to the most light is white",
        switch=Choice("Set Exposure", "Make light brighter than it was taken, in stops"),
        start=0.0,
    )
