"""Colours of other primaries, against the standards that define them."""

import numpy as np
import pytest
from rsibr.rsibr_addon.files.chromaticities import REC_709, XYZ, rec709_from

ACES_AP0 = (0.7347, 0.2653, 0.0, 1.0, 0.0001, -0.077, 0.32168, 0.33767)
REC_2020 = (0.708, 0.292, 0.170, 0.797, 0.131, 0.046, 0.3127, 0.3290)
P3_D65 = (0.680, 0.320, 0.265, 0.690, 0.150, 0.060, 0.3127, 0.3290)


def test_rec_709_stays_exactly_itself() -> None:
    np.testing.assert_array_equal(rec709_from(REC_709), np.eye(3))
    # As float32 in a file
    np.testing.assert_array_equal(rec709_from(np.float32(REC_709)), np.eye(3))


def test_rec_2020_as_its_standard_converts() -> None:
    # ITU-R BT.2087-0 gives the inverse, to four digits
    published = np.array([[0.6274, 0.3293, 0.0433], [0.0691, 0.9195, 0.0114], [0.0164, 0.0880, 0.8956]])
    np.testing.assert_allclose(np.linalg.inv(rec709_from(REC_2020)), published, rtol=0, atol=1e-4)


@pytest.mark.parametrize("chromaticities", [ACES_AP0, REC_2020, P3_D65, XYZ])
def test_grey_stays_grey(chromaticities: tuple[float, ...]) -> None:
    np.testing.assert_allclose(rec709_from(chromaticities) @ np.ones(3), np.ones(3), rtol=1e-12)


def test_aces_as_its_own_transform_converts() -> None:
    # The Academy's ACES2065-1 to linear Rec. 709 matrix with D60 -> D65 by CAT02; Bradford's differs
    # from that by less than 1e-2
    published = np.array([[2.5216, -1.1369, -0.3849], [-0.2762, 1.3697, -0.0935], [-0.0159, -0.1478, 1.1637]])
    np.testing.assert_allclose(rec709_from(ACES_AP0), published, rtol=0, atol=1e-2)


@pytest.mark.parametrize(
    "chromaticities",
    [
        (0.64, 0.33, 0.64, 0.33, 0.15, 0.06, 0.3127, 0.3290),
        (0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3, 0.0),
        (np.nan,) * 8,
    ],
)
def test_impossible_primaries_are_refused(chromaticities: tuple[float, ...]) -> None:
    with pytest.raises(ValueError, match="span no colours"):
        rec709_from(chromaticities)
