"""Small pictures of maps: means, and sheets side by side."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.pictures.thumbnail import thumbnail

RNG = np.random.default_rng(3)


def test_small_maps_stay_as_they_are() -> None:
    radiance = RNG.random((5, 7, 3))
    np.testing.assert_array_equal(thumbnail(radiance, 7), radiance)


def test_texels_are_means_of_blocks() -> None:
    radiance = RNG.random((64, 128, 3))
    small = thumbnail(radiance, 32)
    assert small.shape == (16, 32, 3)
    np.testing.assert_allclose(small.mean(axis=(0, 1)), radiance.mean(axis=(0, 1)))
    np.testing.assert_allclose(small[3, 9], radiance[12:16, 36:40].mean(axis=(0, 1)))


@pytest.mark.parametrize(("count", "across"), [(2, 2), (6, 3)])
def test_sheets_lie_in_reading_order(count: int, across: int) -> None:
    # From the top: sheet k has the value k, and its lowest row 0.5 more
    strip = np.repeat(np.arange(count, dtype=float)[::-1], 4)
    strip[::4] += 0.5
    small = thumbnail(np.broadcast_to(strip[:, None, None], (4 * count, 4, 3)), 100)
    assert small.shape == (4 * count // across, 4 * across, 3)
    from_top = small[::-1, :, 0]
    for sheet in range(count):
        down, right = divmod(sheet, across)
        np.testing.assert_array_equal(from_top[4 * down : 4 * down + 3, 4 * right : 4 * right + 4], sheet)
        np.testing.assert_array_equal(from_top[4 * down + 3, 4 * right : 4 * right + 4], sheet + 0.5)
