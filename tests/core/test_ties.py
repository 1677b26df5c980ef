"""Decisions between values that are equal but for rounding."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.half_floats import half_holds
from rsibr.rsibr_addon.core.light.exposure.merge import BLACK, merge_bracket
from rsibr.rsibr_addon.core.light.exposure.response import linear_response
from rsibr.rsibr_addon.core.light.lamps import LampLight, add_lamps
from rsibr.rsibr_addon.core.lobes.bank import octaves
from rsibr.rsibr_addon.core.lobes.clustering import clustered
from rsibr.rsibr_addon.core.lobes.kautz_mccool import Remainder, graded_angles
from rsibr.rsibr_addon.core.ties import first_greatest, greatest_first

EPS = 4e-16
"""What a sum in another order may differ by, of values near 1."""


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("noise", [-EPS, 0.0, EPS])
def test_of_equal_values_the_first_is_chosen(noise: float, scale: float) -> None:
    values = scale * np.array([0.3, 1.0, 0.3 + noise, 1.0 + noise, 0.3 - noise])
    assert first_greatest(values) == 1
    np.testing.assert_array_equal(greatest_first(values), [1, 3, 0, 2, 4])
    # What is greater by more than rounding is chosen wherever it is
    values[4] = scale * (1.0 + 1e-6)
    assert first_greatest(values) == 4
    np.testing.assert_array_equal(greatest_first(values), [4, 1, 3, 0, 2])
    np.testing.assert_array_equal(greatest_first(np.zeros(3)), [0, 1, 2])


@pytest.mark.parametrize("noise", [-EPS, EPS])
def test_lobes_equally_near_to_two_sequences_stay_in_their_order(noise: float) -> None:
    offsets = np.array([[(0.0, 0.0), (0.0, 0.0)], [(-1.0, 0.0), (1.0 + noise, 0.0)]])
    np.testing.assert_array_equal(clustered(offsets)[0], [0, 1])


@pytest.mark.parametrize("noise", [-1e-15, 1e-15])
def test_a_lamp_between_two_texels_is_in_the_second(noise: float) -> None:
    azimuth = 0.25 * np.pi + noise  # A border of every width that 8 divides
    lamp = LampLight(np.array([[np.cos(azimuth), np.sin(azimuth), 0.0]]), np.ones(3))
    lit = np.argwhere(add_lamps(np.zeros((8, 16, 3)), [lamp])[..., 0])
    np.testing.assert_array_equal(lit, [[4, 6]])


@pytest.mark.parametrize("noise", [-EPS, EPS])
def test_a_bank_reaches_a_power_of_two_and_no_further(noise: float) -> None:
    sharpest = octaves(1.0).concentrations[0] * 2.0**5
    assert octaves(sharpest * (1.0 + noise)).concentrations[-1] == sharpest


def test_the_peak_of_a_symmetric_lobe_is_the_same_whichever_side_rounding_favours() -> None:
    def peaks(favoured: float) -> np.ndarray:
        def brdf(light_dir: np.ndarray, view_dir: np.ndarray) -> np.ndarray:
            aside = np.abs(light_dir[..., 1]) * light_dir[..., 2]
            return (aside * (1.0 + EPS * np.sign(favoured * light_dir[..., 1])))[..., None] * np.ones(3)

        return Remainder(brdf, 0.5, graded_angles(0.01), clamped=True).peak()

    np.testing.assert_array_equal(peaks(1.0), peaks(-1.0))


def test_half_floats_hold_the_largest_of_them_with_a_last_bit_more() -> None:
    largest = np.float32(65504.0)
    assert half_holds([np.array([1.0, np.nextafter(largest, np.float32(1e9))], dtype=np.float32)])
    assert not half_holds([np.array([1.0, 65520.0], dtype=np.float32)])


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_black_is_black_in_either_precision(dtype: type) -> None:
    photograph = np.full((8, 8, 3), 0.5)
    photograph[:4] = BLACK
    merged = merge_bracket([photograph.astype(dtype)] * 2, [1.0, 2.0], linear_response(), align=False)
    assert merged.black == 0.5
