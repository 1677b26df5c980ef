"""Mip chains: in texture space against sums over texels, of GGX lobes against brute force."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.conventions import Array
from rsibr.rsibr_addon.core.errors import RangeError
from rsibr.rsibr_addon.core.filtering.prefilter import prefilter_exact
from rsibr.rsibr_addon.core.filtering.radial_lobes import ggx_n_dot_l_lobe, phong_lobe
from rsibr.rsibr_addon.core.kinds.mip_chain.ggx import (
    ROUGHNESS_RULES,
    ggx_mips,
    linear_roughness,
    quadratic_roughness,
)
from rsibr.rsibr_addon.core.kinds.mip_chain.lobe_mips import TOLERANCE, environment_faces
from rsibr.rsibr_addon.core.kinds.mip_chain.phong import box_exponents, phong_mips
from rsibr.rsibr_addon.core.kinds.mip_chain.texture_space import (
    box_halved,
    filtered_mips,
    tent_halved,
    with_borders,
)
from rsibr.rsibr_addon.core.maps import cube_map
from rsibr.rsibr_addon.core.maps.representation import representation
from rsibr.rsibr_addon.core.resample import bilinear, lookup

CUBE = representation("cube_map")
RNG = np.random.default_rng(11)
FILTERS = pytest.mark.parametrize("halved", [box_halved, tent_halved])


def lit_environment(height: int, row: int, column: int) -> Array:
    radiance = np.zeros((height, 2 * height, 3))
    radiance[row, column] = (1.0, 2.0, 3.0)
    return radiance


@FILTERS
def test_a_chain_halves_down_to_a_texel_and_keeps_constant_light(halved) -> None:
    mips = filtered_mips(np.full((6, 16, 16, 3), (1.0, 2.0, 0.0)), halved)
    assert [mip.shape for mip in mips] == [(6, n, n, 3) for n in (16, 8, 4, 2, 1)]
    for mip in mips:
        np.testing.assert_allclose(mip, np.broadcast_to((1.0, 2.0, 0.0), mip.shape), rtol=1e-14)


def test_the_box_keeps_every_faces_light_to_itself() -> None:
    faces = RNG.random((6, 8, 8, 3))
    smallest = filtered_mips(faces, box_halved)[-1]
    np.testing.assert_allclose(smallest[:, 0, 0], faces.mean(axis=(1, 2)), rtol=1e-14)
    np.testing.assert_array_equal(box_halved(faces)[2, 1, 3], faces[2, 2:4, 6:8].mean(axis=(0, 1)))


def test_the_tent_is_the_weighted_sum_over_texels_across_edges() -> None:
    faces = RNG.random((6, 8, 8, 2))
    solid_angle = cube_map.texel_solid_angle(8)
    found = tent_halved(faces)
    for face, row, column in [(0, 1, 2), (3, 0, 1), (5, 2, 3), (1, 3, 2), (4, 1, 0)]:
        total, weights = np.zeros(2), 0.0
        for j, across_j in enumerate((1, 3, 3, 1), 2 * row - 1):
            for i, across_i in enumerate((1, 3, 3, 1), 2 * column - 1):
                texel = cube_map.wrap(*(np.array(n) for n in (i, j, face)), 8, 8)
                at = int(texel[2]), int(texel[1]), int(texel[0])
                assert at[0] != cube_map.NOWHERE  # these five reach over an edge at most
                total += across_j * across_i * solid_angle[at] * faces[at]
                weights += across_j * across_i * solid_angle[at]
        np.testing.assert_allclose(found[face, row, column], total / weights, rtol=1e-13)


def test_the_tent_keeps_power_and_treats_all_corners_alike() -> None:
    # A texel's shares in coarse texels sum to 1 but for their normalisation by solid angle, which varies by a
    # factor 5 over a face: over 16 texels a side by 4 % between neighbours, next to a corner by a third.
    faces = RNG.random((6, 16, 16, 1))
    mips = filtered_mips(faces, tent_halved)
    power = [float(np.sum(mip[..., 0] * cube_map.texel_solid_angle(mip.shape[1]))) for mip in mips]
    np.testing.assert_allclose(power, power[0], rtol=0.02)
    lit = np.zeros((6, 4, 4, 1))
    lit[:, [0, 0, -1, -1], [0, -1, 0, -1]] = 1.0
    for smaller in filtered_mips(lit, tent_halved)[1:]:
        np.testing.assert_allclose(smaller, np.full_like(smaller, smaller[0, 0, 0, 0]), rtol=1e-13)


def test_bilinear_lookups_within_borders_are_seamless_lookups() -> None:
    faces = RNG.random((6, 4, 4, 3))
    bordered = with_borders(faces)
    assert bordered.shape == (6, 6, 6, 3)
    np.testing.assert_array_equal(bordered[:, 1:-1, 1:-1], faces)
    direction = RNG.normal(size=(1000, 3))
    near_corners = np.sign(direction[:500]) + 0.05 * RNG.normal(size=(500, 3))
    direction = np.concatenate([direction, near_corners])
    uv, sheet = cube_map.uv_from_direction(direction)
    inside = (uv * 4.0 + 1.0) / 6.0
    found = bilinear(bordered, inside, lambda i, j, width, height: (i, j), layer=sheet)
    # Sums of the same products in another order.
    np.testing.assert_allclose(found, lookup(faces, direction, CUBE), rtol=0, atol=1e-14)


def test_across_borders_the_tent_gives_light_where_the_box_does_not() -> None:
    # Light of one face: the box leaves all of it there, the tent gives the neighbours their share.
    faces = np.zeros((6, 16, 16, 1))
    faces[0] = 1.0
    box, tent = (filtered_mips(faces, halved)[-1][:, 0, 0, 0] for halved in (box_halved, tent_halved))
    np.testing.assert_array_equal(box, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    np.testing.assert_allclose(tent[2:], tent[2], rtol=1e-12)
    assert 0.05 < tent[2] < tent[0] < 0.7
    assert tent[1] == 0.0  # what faces the other way


def test_roughness_rules() -> None:
    assert linear_roughness(5) == (0.0, 0.25, 0.5, 0.75, 1.0)
    # 2 r - r^2 = mip / 4
    np.testing.assert_allclose([2.0 * r - r * r for r in quadratic_roughness(5)], linear_roughness(5))
    assert [rule(1) for rule in ROUGHNESS_RULES.values()] == [(0.0,), (0.0,)]


@pytest.mark.slow
def test_ggx_mips_are_the_sum_over_texels() -> None:
    radiance = RNG.random((64, 128, 3)) ** 6
    radiance[40, 17] = 500.0
    roughness = (0.0, 0.4, 0.6, 0.8, 1.0)
    mips = list(ggx_mips(radiance, 16, roughness).mips)
    assert [mip.faces.shape for mip in mips] == [(6, n, n, 3) for n in (16, 8, 4, 2, 1)]
    assert mips[0].bound == 0.0
    np.testing.assert_array_equal(mips[0].faces, environment_faces(radiance, 16))
    for mip, r in zip(mips[1:], roughness[1:], strict=True):
        directions = CUBE.texel_directions(mip.faces.shape[1])
        exact = prefilter_exact(radiance, [ggx_n_dot_l_lobe(r**2)], directions)[0]
        error = np.abs(mip.faces - exact)
        assert error.max() <= mip.bound < 0.01 * exact.max()
        # The tolerance is of the whole sphere's mean square; six texels of it may do worse.
        assert np.sqrt(np.mean(error**2) / np.mean(exact**2)) < 5.0 * TOLERANCE
        assert mip.faces.min() >= 0.0


@pytest.mark.parametrize(("row", "column"), [(3, 40), (64, 0), (80, 200)])
def test_filtered_lobes_do_not_lean(row: int, column: int) -> None:
    # A lit texel's lobe is symmetric about the texel: so is, up to the tolerance, what is filtered.
    radiance = lit_environment(128, row, column)
    towards = environment_direction(128, row, column)
    mip = list(ggx_mips(radiance, 64, (0.0, 0.35)).mips)[1]
    size = mip.faces.shape[1]
    weight = mip.faces[..., 0] * cube_map.texel_solid_angle(size)
    mean = np.einsum("fji,fjix->x", weight, CUBE.texel_directions(size))
    lean = np.arccos(min(float(mean @ towards / np.linalg.norm(mean)), 1.0))
    # Texels of 2.8 degrees sample a lobe 16 degrees wide: their sum is off by far less than .05 degrees.
    assert np.degrees(lean) < 0.05


def environment_direction(height: int, row: int, column: int) -> Array:
    u, v = (column + 0.5) / (2 * height), (row + 0.5) / height
    phi, theta = 2.0 * np.pi * (0.5 - u), np.pi * (1.0 - v)
    return np.array([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)])


def test_a_mirror_shows_the_environment_at_any_size() -> None:
    radiance = lit_environment(32, 20, 9)
    towards = environment_direction(32, 20, 9)
    for size in (32, 4):
        faces = environment_faces(radiance, size)
        brightest = np.unravel_index(np.argmax(faces[..., 0]), faces.shape[:3])
        cosine = CUBE.texel_directions(size)[brightest] @ towards
        assert cosine > np.cos(np.pi / size)
    power = np.einsum("fji,fjic->c", cube_map.texel_solid_angle(4), faces)
    texel = 2.0 * np.pi / 64 * (np.cos(np.pi * 11 / 32) - np.cos(np.pi * 12 / 32))
    np.testing.assert_allclose(power, texel * np.array([1.0, 2.0, 3.0]), rtol=1e-9)


@pytest.mark.parametrize("height", [8, 32])
def test_a_coarse_map_is_filtered_as_what_lies_between_its_texels(height: int) -> None:
    roughness = linear_roughness(6)
    coarse, fine = (
        [mip.faces for mip in ggx_mips(_upward_light(rows), 32, roughness).mips] for rows in (height, 256)
    )
    # Between texels pi / height apart a sine is off by (pi / height)^2 / 8; the lobe of mip 1 sees points six
    # to its width, whose sum is off by some percent of the light, 3 at most
    for mip, (found, expected) in enumerate(zip(coarse, fine, strict=True)):
        assert np.abs(found - expected).max() < (np.pi / height) ** 2 / 8 + (0.02 if mip else 2e-3), mip


def _upward_light(rows: int) -> np.ndarray:
    """Radiance 2 + z, shape (rows, 2 rows, 3)."""
    height = np.sin(np.pi * ((np.arange(rows) + 0.5) / rows - 0.5))
    return np.broadcast_to(2.0 + height[:, None, None], (rows, 2 * rows, 3))


def test_phong_mips_are_the_sum_over_texels() -> None:
    radiance = RNG.random((64, 128, 3)) ** 8
    exponents = (np.inf, 60.0, 20.0, 1.0)
    mips = list(phong_mips(radiance, 8, exponents).mips)
    np.testing.assert_array_equal(mips[0].faces, environment_faces(radiance, 8))
    for mip, exponent in list(enumerate(exponents))[1:]:
        exact = prefilter_exact(radiance, [phong_lobe(exponent)], CUBE.texel_directions(8 >> mip))[0]
        error = np.abs(mips[mip].faces - exact)
        assert error.max() <= mips[mip].bound
        assert np.sqrt(np.mean(error**2)) < 10.0 * TOLERANCE * np.sqrt(np.mean(exact**2))


def test_exponents_go_with_box_filters() -> None:
    assert box_exponents(1) == (np.inf,)
    exponents = box_exponents(256)
    assert len(exponents) == 9
    assert exponents[-1] == 1.0  # six faces spread even wider
    # The rule of the page: N + 2 is 1.65 of the square of a mip's width.
    for mip in range(2, 7):
        assert (exponents[mip] + 2.0) / (256 >> mip) ** 2 == pytest.approx(1.65, rel=0.1)
    for bad, sentence in (((4.0, 9.0), "do not descend"), ((4.0, 0.5), "do not descend to 1 or more")):
        with pytest.raises(RangeError, match=sentence):
            list(phong_mips(np.ones((4, 8, 3)), 4, bad).mips)


def test_bad_chains_are_refused() -> None:
    radiance = np.ones((16, 32, 3))
    with pytest.raises(RangeError, match="cannot be 48 texels wide: choose a power of 2"):
        list(ggx_mips(radiance, 48, (0.0, 0.5)).mips)
    with pytest.raises(RangeError, match="has 1 to 3 mips, not 4"):
        list(ggx_mips(radiance, 4, (0.0, 0.5, 0.7, 1.0)).mips)
    with pytest.raises(RangeError, match=r"0, 0\.7, 0\.5 do not ascend"):
        list(ggx_mips(radiance, 4, (0.0, 0.7, 0.5)).mips)
    with pytest.raises(
        RangeError, match=r"Mip 1 cannot have roughness 0\.02, choose.*degrees wide needs more"
    ):
        list(ggx_mips(radiance, 4, (0.0, 0.02, 0.5)).mips)
