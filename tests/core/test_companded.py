"""Rounding in steps that grow with the values."""

import numpy as np
from rsibr.rsibr_addon.core.companded import STEPS, UNIT, companded


def test_no_value_is_further_off_than_promised() -> None:
    rng = np.random.default_rng(1)
    values = rng.choice([-1.0, 1.0], 10000) * 10.0 ** rng.uniform(-9.0, 5.0, 10000)
    rounded = companded(values)
    assert np.isclose(rounded.unit, UNIT * np.abs(values).mean())
    allowed = (np.abs(values) + rounded.unit) / (2.0 * STEPS)
    error = np.abs(rounded.values() - values)
    assert np.all(error <= 1.002 * allowed)  # terms of second order
    assert error.max() > 0.5 * allowed.max()


def test_large_and_small_values_fit_into_16_bits_and_black_stays_black() -> None:
    values = np.array([0.0, 1e-30, 3e5, -3e5] + [1.0] * 100)
    rounded = companded(values)
    assert np.abs(rounded.codes).max() < 2**15
    assert rounded.values()[0] == 0.0
    assert companded(np.zeros(4)).values().tolist() == [0.0] * 4
