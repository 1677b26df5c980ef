"""Painted whites become lamps."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import RangeError
from rsibr.rsibr_addon.core.light.painted import lift_whites

WHITE = (200.0, 120.0, 60.0)


def test_white_becomes_the_lamp_and_darks_stay() -> None:
    np.testing.assert_allclose(lift_whites(np.ones(3), WHITE, 0.7), WHITE)
    darks = np.random.default_rng(0).random((50, 3)) * 0.7
    np.testing.assert_array_equal(lift_whites(darks, WHITE, 0.7), darks)
    # A pure colour is paint, not light
    np.testing.assert_array_equal(lift_whites([1.0, 0.0, 0.0], 1000.0, 0.7), [1.0, 0.0, 0.0])
    np.testing.assert_array_equal(lift_whites(darks / 0.7, 1.0, 0.0), darks / 0.7)


def test_a_ramp_stays_a_ramp_without_a_kink() -> None:
    grey = np.linspace(0.0, 1.0, 100_001)
    lifted = lift_whites(np.repeat(grey[:, None], 3, axis=1), WHITE, 0.7)
    slope = np.diff(lifted, axis=0) / 1e-5
    assert np.all(slope > 0.0)
    # The slope's own slope is at most white ((2 ln white / 0.3)^2 + 4 ln white / 0.3 + 2 ln white / 0.09)
    log_white = np.log(WHITE)
    most = (2.0 * log_white / 0.3) ** 2 + 4.0 * log_white / 0.3 + 2.0 * log_white / 0.3**2
    assert np.all(np.abs(np.diff(slope, axis=0)).max(axis=0) < 1e-5 * np.array(WHITE) * most)
    knee = np.searchsorted(grey, 0.7)
    np.testing.assert_allclose(slope[knee - 2 : knee + 2], 1.0, atol=1e-2)


def test_numbers_out_of_range() -> None:
    for white in (0.5, np.inf, np.nan, (1.0, 2.0, 0.9)):
        with pytest.raises(RangeError, match="radiance of 1 or more"):
            lift_whites(np.ones(3), white, 0.5)
    for knee in (-0.1, 1.0, np.nan):
        with pytest.raises(RangeError, match="choose one from 0 to below 1"):
            lift_whites(np.ones(3), 2.0, knee)
