"""An environment as lamps: all of its light, in shares alike, where it is."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.conventions import Array, texel_centres
from rsibr.rsibr_addon.core.filtering.irradiance import irradiance_exact
from rsibr.rsibr_addon.core.light.luminance import luminance
from rsibr.rsibr_addon.core.light.median_cut import lamps_above
from rsibr.rsibr_addon.core.maps import equirect

RNG = np.random.default_rng(91)


@pytest.mark.parametrize("rows", [16, 64])
def test_lamps_give_all_the_irradiance(rows: int) -> None:
    radiance = RNG.random((rows, 2 * rows, 3)) ** 4
    lamps = lamps_above(radiance, 64)
    assert 50 <= len(lamps.directions) <= 64
    expected = irradiance_exact(radiance, (0.0, 0.0, 1.0))
    np.testing.assert_allclose(lamps.irradiance.sum(axis=0), expected, rtol=1e-12)
    assert np.all(lamps.directions[:, 2] > 0.0)
    np.testing.assert_allclose(np.linalg.norm(lamps.directions, axis=1), 1.0)


def test_shares_are_alike() -> None:
    radiance = 1.0 + RNG.random((128, 256, 3))
    shares = luminance(lamps_above(radiance, 256).irradiance)
    # Each cut is wrong by at most a row or a column of texels, of at least 4 here
    assert shares.max() < 2.0 * shares.mean()
    assert shares.min() > 0.4 * shares.mean()


def test_lamps_of_even_light_are_spread_evenly() -> None:
    lamps = lamps_above(np.ones((64, 128, 3)), 64)
    assert len(lamps.directions) == 64
    # On the plane an even sky is an even disk, of which each lamp has a 64th, cut across its longer side
    places = np.stack(np.meshgrid(*2 * [np.linspace(-1.0, 1.0, 101)]), axis=-1).reshape(-1, 2)
    places = places[np.linalg.norm(places, axis=1) < 1.0]
    apart = np.linalg.norm(places[:, None] - lamps.directions[:, :2], axis=-1).min(axis=1)
    assert apart.max() < np.sqrt(2.0 * np.pi / 64.0)  # the diagonal of a square of that area


def test_a_sun_is_where_it_is() -> None:
    radiance = np.full((64, 128, 3), 0.01)
    radiance[50, 37] = 1e4
    lamps = lamps_above(radiance, 64)
    brightest = luminance(lamps.irradiance).argmax()
    towards = equirect.direction_from_uv(texel_centres(128, 64))[50, 37]
    assert lamps.directions[brightest] @ towards > 1.0 - 1e-6
    sun = 1e4 * equirect.texel_solid_angle(128, 64)[50, 0] * towards[2]
    np.testing.assert_allclose(lamps.irradiance[brightest], sun, rtol=1e-3)


def test_few_texels_make_few_lamps() -> None:
    radiance: Array = np.zeros((8, 16, 3))
    assert len(lamps_above(radiance, 16).directions) == 0
    radiance[5, 3] = radiance[7, 1] = 1.0
    assert len(lamps_above(radiance, 16).directions) == 2


def test_a_plane_may_have_any_normal() -> None:
    radiance, up = RNG.random((64, 128, 3)) ** 4, np.array([0.6, -0.64, 0.48])
    lamps = lamps_above(radiance, 64, up)
    expected = irradiance_exact(radiance, up)
    # The plane's horizon crosses texels, which count by their middles
    np.testing.assert_allclose(lamps.irradiance.sum(axis=0), expected, rtol=1e-3)
    assert np.all(lamps.directions @ up > 0.0)
