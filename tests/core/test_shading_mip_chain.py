"""Shading from mip chains: closed forms, continuity, and what is refused."""

from dataclasses import replace

import numpy as np
import pytest
from rsibr.rsibr_addon.core.conventions import Array
from rsibr.rsibr_addon.core.errors import RangeError, ShapeError
from rsibr.rsibr_addon.core.filtering.harmonics.analysis import analyse_environment
from rsibr.rsibr_addon.core.filtering.irradiance import irradiance_exact
from rsibr.rsibr_addon.core.geometry.directions import normalize, reflect
from rsibr.rsibr_addon.core.kinds.mip_chain.chain import MipChain
from rsibr.rsibr_addon.core.kinds.mip_chain.lobe_mips import environment_faces
from rsibr.rsibr_addon.core.kinds.mip_chain.shading import (
    Borders,
    MipLook,
    diffuse_radiance,
    glossy_radiance,
    mip_chain_radiance,
)
from rsibr.rsibr_addon.core.kinds.mip_chain.texture_space import box_halved, filtered_mips, tent_halved
from rsibr.rsibr_addon.core.maps import cube_map

RNG = np.random.default_rng(31)
NORMALS = normalize(RNG.normal(size=(500, 3)))
VIEWS = normalize(NORMALS + 0.5 * RNG.normal(size=(500, 3)))
FACING = np.einsum("ni,ni->n", NORMALS, VIEWS) > 0.0
NORMALS, VIEWS = NORMALS[FACING], VIEWS[FACING]


def chain_of(radiance: Array, size: int, halved=tent_halved) -> MipChain:
    mips = filtered_mips(environment_faces(radiance, size).astype(np.float32), halved)
    return MipChain(mips, analyse_environment(radiance, 2).real(2))


@pytest.fixture(scope="module")
def random() -> MipChain:
    return chain_of(RNG.random((16, 32, 3)), 16)


def test_white_surroundings_show_albedo_and_fresnel_alone() -> None:
    chain = chain_of(np.full((64, 128, 3), (1.0, 2.0, 3.0)), 8)
    look = MipLook(f0=(0.1, 0.2, 0.3), kd=(0.5, 0.6, 0.7), mip=1.5)
    cosine = np.einsum("ni,ni->n", NORMALS, VIEWS)[:, None]
    fresnel = np.array(look.f0) + (1.0 - np.array(look.f0)) * (1.0 - cosine) ** 5
    expected = ((1.0 - fresnel) * look.kd + fresnel) * (1.0, 2.0, 3.0)
    # The sum of texels' harmonics for the integral: l (l + 1) / 24 times (pi / 64)^2 at degree 2.
    np.testing.assert_allclose(mip_chain_radiance(chain, NORMALS, VIEWS, look), expected, rtol=1e-3)


def test_at_grazing_angles_only_the_mirror_direction_counts(random: MipChain) -> None:
    view = np.cross(NORMALS, normalize(RNG.normal(size=NORMALS.shape)))
    view = normalize(view)
    for mip in (0.0, 1.3):
        found = mip_chain_radiance(random, NORMALS, view, MipLook(mip=mip))
        glossy = glossy_radiance(random, reflect(view, NORMALS), mip, Borders.SEAMLESS)
        np.testing.assert_allclose(found, glossy, rtol=1e-12)


def test_diffuse_light_is_the_irradiance_over_pi() -> None:
    radiance = 1.0 + RNG.random((16, 32, 3))
    found = diffuse_radiance(chain_of(radiance, 4), NORMALS, (0.5, 1.0, 0.25))
    # Random texels have little beyond degree 2 that the cosine lobe lets through: -1/24 of degree 4.
    expected = irradiance_exact(radiance, NORMALS) * np.array([0.5, 1.0, 0.25]) / np.pi
    np.testing.assert_allclose(found, expected, rtol=0.01)
    sun = np.zeros((16, 32, 3))
    sun[12, 3] = 1e4
    assert diffuse_radiance(chain_of(sun, 4), NORMALS, (1.0, 1.0, 1.0)).min() == 0.0


def test_a_mirror_direction_finds_its_texel(random: MipChain) -> None:
    size = 16
    for face, row, column in [(0, 3, 12), (1, 0, 15), (2, 8, 1), (3, 15, 15), (4, 7, 7), (5, 2, 9)]:
        uv = ((column + 0.5) / size, (row + 0.5) / size)
        direction = cube_map.direction_from_uv(uv, np.array(face))
        for borders in Borders:
            found = glossy_radiance(random, direction, 0.0, borders)
            np.testing.assert_allclose(found, random.mips[0][face, row, column], rtol=1e-12)


def test_levels_between_mips_are_linear_and_end_at_the_last(random: MipChain) -> None:
    one, other, between = (
        glossy_radiance(random, NORMALS, level, Borders.SEAMLESS) for level in (2.0, 3.0, 2.25)
    )
    np.testing.assert_allclose(between, 0.75 * one + 0.25 * other, rtol=1e-12)
    assert MipLook(mip=9.4).level(random.lobes) == 4.0
    assert MipLook(mip=2.3).level(random.lobes) == 2.3


def test_the_border_problem_and_its_absence() -> None:
    # [Kautz2004] figure 4: at b = 9.4 the six faces show. Light comes from one side.
    radiance = np.zeros((32, 64, 3))
    radiance[8:20, 30:50] = 5.0
    box, tent = chain_of(radiance, 16, box_halved), chain_of(radiance, 16)
    # Pairs of directions a thousandth of a radian apart, on both sides of an edge of the cube each.
    along = RNG.uniform(-0.9, 0.9, size=(400, 1))
    edge = np.concatenate([np.ones((400, 2)), along], axis=1) * RNG.choice([-1.0, 1.0], size=(400, 3))
    across = np.stack([normalize(edge * (1.0 + step, 1.0, 1.0)) for step in (-5e-4, 5e-4)])

    def jump(chain: MipChain, borders: Borders) -> float:
        one, other = glossy_radiance(chain, across, MipLook(mip=9.4).level(chain.lobes), borders)
        return float(np.abs(one - other).max())

    whole = float(box.mips[-1].max() - box.mips[-1].min())
    assert jump(box, Borders.CLAMPED) > 0.5 * whole
    # Where lookups interpolate, a step of a thousandth is at most a thousandth of what there is, per texel.
    assert jump(box, Borders.SEAMLESS) < 2e-3 * whole
    assert jump(tent, Borders.SEAMLESS) < 2e-3 * whole
    # Filtering across the borders does not help a lookup that does not: its six colours only differ less.
    assert jump(tent, Borders.CLAMPED) > 10.0 * jump(tent, Borders.SEAMLESS)


def test_a_ggx_chain_is_looked_up_by_roughness(random: MipChain) -> None:
    ggx = replace(random, roughness=(0.0, 0.1, 0.3, 0.7, 1.0))
    assert MipLook(roughness=0.2).level(ggx.lobes) == pytest.approx(1.5)
    assert MipLook(roughness=1.0).level(ggx.lobes) == 4.0
    rough = replace(random, roughness=(0.1, 0.2, 0.3, 0.7, 1.0))
    assert MipLook(roughness=0.05).level(rough.lobes) == 0.0
    with pytest.raises(RangeError, match="does not say how blurred its mips are: bake it again, or choose"):
        MipLook(roughness=0.2).level(random.lobes)


@pytest.mark.parametrize(
    ("values", "sentence"),
    [
        ({"f0": (0.1, 1.2, 0.0)}, "Reflectance cannot be 1.2: choose 0 to 1"),
        ({"kd": (0.1, -0.2, 0.0)}, "Diffuse cannot be -0.2: choose 0 to 1"),
        ({"mip": -0.5}, "Mip cannot be -0.5: choose 0 to"),
        ({"mip": np.nan}, "Mip cannot be nan"),
        ({"roughness": 1.5}, "Roughness cannot be 1.5: choose 0 to 1"),
        ({"roughness": 0.5, "mip": 1.0}, "Roughness and Mip say the same in two ways: give one of them"),
        ({"exponent": 9.0, "mip": 1.0}, "Exponent and Mip say the same"),
        ({"exponent": 9.0, "roughness": 0.0}, "Exponent and Roughness say the same"),
        ({"exponent": 0.5}, "Exponent cannot be 0.5: choose 1 to"),
    ],
)
def test_bad_looks_are_refused(values: dict, sentence: str) -> None:
    with pytest.raises(RangeError, match=sentence):
        MipLook(**values)


def test_bad_chains_are_refused(random: MipChain) -> None:
    with pytest.raises(ShapeError, match=r"Mip 1 must have the shape \(6, 8, 8, 3\)"):
        MipChain((random.mips[0], random.mips[2]), random.harmonics)
    with pytest.raises(ShapeError, match="5 coefficients are not those of any degree"):
        MipChain(random.mips, random.harmonics[:5])
    with pytest.raises(ShapeError, match="coefficients of three"):
        MipChain(random.mips, random.harmonics[:, :2])
    with pytest.raises(RangeError, match="484 coefficients are of a degree above 20: make fewer"):
        MipChain(random.mips, np.zeros((22**2, 3)))
    with pytest.raises(ShapeError, match="5 mips need as many spreads, not 2"):
        replace(random, spread=(0.0, 1.0))
    with pytest.raises(RangeError, match=r"Spreads 0, 0\.1, 0\.05, 0\.2, 0\.3 do not ascend"):
        replace(random, spread=(0.0, 0.1, 0.05, 0.2, 0.3))
    with pytest.raises(ShapeError, match="5 mips need as many roughnesses, not 2"):
        replace(random, roughness=(0.0, 1.0))
    with pytest.raises(RangeError, match="do not ascend"):
        replace(random, roughness=(0.0, 0.5, 0.4, 0.7, 1.0))
