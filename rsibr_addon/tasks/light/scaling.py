"""Light as it is written: with its scale, which the file states."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...core.conventions import Array
from ...core.errors import InputFileError, RangeError
from ...core.light.scale import balancing, brightest_lit, colour_within, white_card
from ...files.radiance_pictures import write_radiance
from ...settings.light import KnownScale, UnknownScale

CARD_IS_WHITE = "white, 1, is what a white card shows that is turned to the most light"
LIT_IS_WHITE = "lamps are cut off, so all but a twentieth of the directions are below white, 1"


@dataclass(frozen=True, eq=False)
class Scale:
    """What light is multiplied by.

    Attributes
    ----------
    gains : ndarray, shape (3,)
    told : str
        Why, as sentences; empty for light that stays as it is.
    """

    gains: Array
    told: str


def write_scaled(
    output: Path,
    radiance: Array,
    settings: UnknownScale | KnownScale,
    force: bool,
    card: Array | None = None,
    cut_off: bool = False,
) -> None:
    """Scale light and write it.

    Parameters
    ----------
    output : Path
        OpenEXR or Radiance HDR, which states the scale.
    radiance : ndarray, shape (height, width, 3)
        A latitude-longitude map, where neither an exposure nor a card is given.
    settings : UnknownScale or KnownScale
    force : bool
    card : ndarray, shape (3,), optional
        Colour of the card where it is not in the map itself.
    cut_off : bool
        Whether the map's lamps end at the white of photographs, so that most of their light is not there.

    Raises
    ------
    InputFileError
        There is no card where the settings have it, or it is black.
    OutputFileError, RangeError
        See `write_radiance`.
    """
    if settings.card is not None and card is None:
        try:
            card = colour_within(radiance, *settings.card)
        except RangeError as error:
            raise InputFileError(f"{output}: {error}") from error
    scale = scale_of(radiance, settings, card, cut_off)
    write_radiance(output, scale.gains * radiance if scale.told else radiance, force, scale.told)


def scale_of(
    radiance: Array, settings: UnknownScale | KnownScale, card: Array | None, cut_off: bool
) -> Scale:
    """What light is to be multiplied by; parameters are those of `write_scaled`."""
    gains: Array = np.ones(3)
    told = []
    if card is not None:
        gains = np.asarray(settings.albedo) / card
        told.append("a card of albedo {:g}, {:g}, {:g} shows just that".format(*settings.albedo))
    elif settings.white_balance is not None:
        gains = balancing(settings.white_balance)
        told.append("{:g}, {:g}, {:g} became grey".format(*settings.white_balance))
    if settings.exposure:
        gains = gains * 2.0**settings.exposure
        stops = "stop" if abs(settings.exposure) == 1.0 else "stops"
        told.append(
            f"{abs(settings.exposure):g} {stops} {'brighter' if settings.exposure > 0.0 else 'darker'}"
        )
    if settings.exposure is None and card is None:
        white, why = white_card(gains * radiance), CARD_IS_WHITE
        if cut_off and (lit := brightest_lit(gains * radiance)) > white:
            white, why = lit, LIT_IS_WHITE
        if white > 0.0:
            gains = gains / white
            told.append(why)
    factors = " ".join(f"{factor:.4g}" for factor in gains)
    return Scale(gains, f"Scaled by {factors}: {'; '.join(told)}." if told else "")
