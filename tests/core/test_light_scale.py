"""How bright light is made: white cards in light known in closed form."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.errors import RangeError
from rsibr.rsibr_addon.core.geometry.directions import normalize
from rsibr.rsibr_addon.core.light.luminance import luminance
from rsibr.rsibr_addon.core.light.scale import balancing, brightest_lit, colour_within, white_card
from rsibr.rsibr_addon.core.maps import equirect

DIRECTIONS = equirect.direction_from_uv(texel_centres(256, 128))


def light_of(brightness: np.ndarray) -> np.ndarray:
    return brightness[..., None] * np.ones(3)


def test_a_white_card_in_even_light_is_as_bright_as_the_light() -> None:
    # A row counts whole or not on the horizon of a card: half a row's width at most, squared
    assert white_card(light_of(np.full((128, 256), 3.0))) == pytest.approx(3.0, rel=1e-3)


def test_a_white_card_is_turned_to_the_lamp() -> None:
    # A cap of half-angle a lights a card that faces it by pi sin^2(a) times its radiance
    towards = normalize((0.3, -0.5, 0.7))
    angle = np.radians(12.0)
    lamp = np.where(DIRECTIONS @ towards > np.cos(angle), 100.0, 0.01)
    assert white_card(light_of(lamp)) == pytest.approx(0.01 + 99.99 * np.sin(angle) ** 2, rel=0.04)


def test_what_is_lit_stays_below_white_where_lamps_are_cut_off() -> None:
    # A room as bright as 0.2 to 0.9 whose lamps, 3 % of all directions, are cut off at 1
    room = 0.55 + 0.35 * DIRECTIONS[..., 0]
    lamps = np.where(DIRECTIONS[..., 2] > 0.94, 1.0, room)
    white = brightest_lit(light_of(lamps))
    share = np.broadcast_to(equirect.texel_solid_angle(256, 128), lamps.shape)
    above = share[lamps > white].sum() / share.sum()
    assert 0.04 < above <= 0.051
    assert white_card(light_of(lamps)) < white


def test_black_light_has_no_white() -> None:
    assert white_card(np.zeros((8, 16, 3))) == brightest_lit(np.zeros((8, 16, 3))) == 0.0


def test_a_balanced_colour_is_grey_and_as_bright() -> None:
    colour = np.array([0.9, 0.5, 0.1])
    balanced = balancing(colour) * colour
    np.testing.assert_allclose(balanced, luminance(colour))


def test_a_circle_is_counted_from_the_top_left_corner() -> None:
    picture = np.full((10, 20, 3), 0.5)
    picture[8:10, 2:4] = 0.1, 0.2, 0.3  # rows 0 and 1 from the top
    np.testing.assert_allclose(colour_within(picture, 3.0, 1.0, 1.0), (0.1, 0.2, 0.3))
    with pytest.raises(RangeError, match="The circle 30,1,1 of the card holds no pixel"):
        colour_within(picture, 30.0, 1.0, 1.0)
    with pytest.raises(RangeError, match="is black: give one that light falls on"):
        colour_within(np.zeros((4, 4, 3)), 2.0, 2.0, 2.0)
