"""How wide mips are: in the same light, chains of every filter and size show a roughness alike."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import RangeError
from rsibr.rsibr_addon.core.filtering.radial_lobes import phong_lobe
from rsibr.rsibr_addon.core.filtering.zonal import zonal_coefficients
from rsibr.rsibr_addon.core.kinds.mip_chain.chain import MipChain
from rsibr.rsibr_addon.core.kinds.mip_chain.mip_lobes import (
    MipLobes,
    ggx_spread,
    phong_exponent,
    phong_spread,
    texture_space_spread,
)
from rsibr.rsibr_addon.core.kinds.mip_chain.shading import Borders, MipLook, glossy_radiance
from rsibr.rsibr_addon.core.kinds.mip_chain.texture_space import box_halved, filtered_mips, tent_halved
from rsibr.rsibr_addon.core.maps.representation import representation

RNG = np.random.default_rng(81)
DIRECTIONS = RNG.normal(size=(20_000, 3))
DIRECTIONS /= np.linalg.norm(DIRECTIONS, axis=1, keepdims=True)
FILTERS = pytest.mark.parametrize("halved", [box_halved, tent_halved])


def chain_of(size: int, halved) -> MipChain:
    """Light 1 + (x, y, z): a lobe of spread s leaves 1 - s of the waves."""
    faces = 1.0 + representation("cube_map").texel_directions(size)
    mips = filtered_mips(faces, halved)
    return MipChain(mips, np.zeros((9, 3)), spread=texture_space_spread(size, halved))


@FILTERS
@pytest.mark.parametrize("size", [32, 128])
@pytest.mark.parametrize(
    ("look", "spread"),
    [
        (MipLook(roughness=0.2), ggx_spread(0.2)),
        (MipLook(roughness=0.6), ggx_spread(0.6)),
        (MipLook(exponent=50.0), phong_spread(50.0)),
    ],
)
def test_a_material_looks_alike_at_every_size(halved, size: int, look: MipLook, spread: float) -> None:
    chain = chain_of(size, halved)
    shown = glossy_radiance(chain, DIRECTIONS, look.level(chain.lobes), Borders.SEAMLESS) - 1.0
    left = 3.0 * np.mean(shown * DIRECTIONS)  # of mean squares 1/3
    # Means over other directions than the spread's: a lobe's spread differs over the cube by some tens of
    # per cent of itself, and 20,000 directions find their mean to a hundredth of that.
    assert 1.0 - left == pytest.approx(spread, rel=0.02, abs=1e-4)


@FILTERS
def test_mips_grow_fourfold(halved) -> None:
    spread = np.array(texture_space_spread(128, halved))
    assert np.all(np.diff(spread) > 0.0)
    # A box of width a and a lookup's tent have a variance of (1/12 + 1/6) a^2 each way, the tents of halvings
    # 1/4 instead of 1/12. The mean texel has 4 pi / 6 n^2; texels differ, and the mean of squares is more.
    variance = (0.25 if halved is box_halved else 5.0 / 12.0) * 4.0 * np.pi / 6.0
    widths = 128 >> np.arange(2, 5)
    np.testing.assert_allclose(spread[2:5] * widths**2, variance, rtol=0.2)
    np.testing.assert_allclose(spread[2:4] * 4.0, spread[3:5], rtol=0.04)


@pytest.mark.parametrize("exponent", [1.0, 20.0, 225.0, 1e5])
def test_phong_s_spread_is_that_of_its_lobe(exponent: float) -> None:
    first = zonal_coefficients(phong_lobe(exponent), 1)[1]
    assert phong_spread(exponent) == pytest.approx(1.0 - first, rel=1e-9)
    assert phong_exponent(phong_spread(exponent)) == pytest.approx(exponent, rel=1e-9)
    assert phong_exponent(0.0) == np.inf


def test_ggx_s_spread_ascends_from_0_to_a_third() -> None:
    spreads = [ggx_spread(roughness) for roughness in np.linspace(0.0, 1.0, 101)]
    assert np.all(np.diff(spreads) > 0.0)
    # At roughness 1 the lobe is cos / pi, whose mean cosine is 2/3.
    assert (spreads[0], spreads[-1]) == (0.0, pytest.approx(1.0 / 3.0))


def test_exponents_are_found_in_a_ggx_chain() -> None:
    lobes = MipLobes(3, (0.0, 0.4, 1.0))
    exponent = phong_exponent(ggx_spread(0.4))
    assert lobes.level_of_exponent(exponent) == pytest.approx(1.0)
    assert lobes.level_of_exponent(1e9) < 1e-6
    with pytest.raises(RangeError, match="bake it again, or choose a mip"):
        MipLobes(3).level_of_exponent(9.0)
