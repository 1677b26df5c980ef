"""The sRGB curve, by the standard's own values."""

import numpy as np
from rsibr.rsibr_addon.core.light.transfer_curve import linear_from_srgb, srgb_from_linear


def test_ends_middle_and_the_straight_piece() -> None:
    # Below 0.04045 the slope is 1 / 12.92
    np.testing.assert_allclose(linear_from_srgb([0.0, 1.0, 0.01292]), [0.0, 1.0, 0.001], rtol=1e-15)
    # 18 percent grey is level 118 of 255, to half a level, which is 2.4 * 0.5 / 118 of it
    np.testing.assert_allclose(linear_from_srgb(118 / 255), 0.18, rtol=0.0102)


def test_it_inverts_the_encoding() -> None:
    linear = np.linspace(0.0, 1.0, 1001)
    encoded = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    # The standard's two pieces meet but for the rounding of its constants
    np.testing.assert_allclose(linear_from_srgb(encoded), linear, atol=1e-7)


def test_encoding_is_undone_and_stays_within_its_range() -> None:
    encoded = np.linspace(0.0, 1.0, 1001)
    # As above
    np.testing.assert_allclose(srgb_from_linear(linear_from_srgb(encoded)), encoded, atol=1e-7)
    np.testing.assert_allclose(srgb_from_linear([-1.0, 7.0]), [0.0, 1.0], rtol=1e-15)
