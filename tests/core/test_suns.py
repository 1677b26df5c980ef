"""Suns that GGX itself reflects, where lobes would show themselves."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf.fresnel_powers import schlick
from rsibr.rsibr_addon.core.brdf.ggx import ggx_ndf
from rsibr.rsibr_addon.core.brdf.principled import Principled, Surface
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.geometry.camera import Camera
from rsibr.rsibr_addon.core.geometry.directions import dot, normalize, reflect
from rsibr.rsibr_addon.core.geometry.lit_sphere import environment_about, ring_radiance
from rsibr.rsibr_addon.core.kinds.kernel_pyramid import shading
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.bake import bake_pyramid
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.pyramid import OCTAHEDRAL, Pyramid
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.shading import principled_radiance
from rsibr.rsibr_addon.core.lobes.bank import KernelBank
from rsibr.rsibr_addon.core.maps import equirect
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.core.resample import lookup
from rsibr.rsibr_addon.core.suns import MOST_SUNS, NO_SUNS, Suns, find_suns, lamp_suns
from rsibr.rsibr_addon.files.kinds.kernel_pyramid import shipped_families

HEIGHT, WIDTH = 128, 256
SUN = (90, 70), (90, 71), (91, 70)
"""Texels."""

FRAME = Camera((0.0, 0.0, 1.0)).frame


def sky(sun: float = 4000.0) -> np.ndarray:
    """A sky over a floor, neither brighter than 1, and a sun of three texels."""
    texels = equirect.direction_from_uv(texel_centres(WIDTH, HEIGHT))
    light = np.where(texels[..., 2:] > 0.0, [0.3, 0.5, 1.0], [0.4, 0.2, 0.1])
    for row, column in SUN:
        light[row, column] = sun, 0.8 * sun, 0.5 * sun
    return light


@cache
def pyramid() -> Pyramid:
    return drain(bake_pyramid(sky(), 256)).pyramid


def test_suns_and_what_is_below_them_are_the_light() -> None:
    light, suns = sky(), find_suns(sky())
    assert len(suns) == len(SUN)
    np.testing.assert_allclose(suns.ceiling, [0.4, 0.5, 1.0])
    solid_angle = equirect.texel_solid_angle(WIDTH, HEIGHT)[..., None]
    taken = np.sum((light - np.minimum(light, suns.ceiling)) * solid_angle, axis=(0, 1))
    np.testing.assert_allclose(suns.irradiance.sum(axis=0), taken)
    centres = equirect.direction_from_uv(texel_centres(WIDTH, HEIGHT))
    towards = sorted(tuple(centres[place].round(6)) for place in SUN)
    assert sorted(map(tuple, suns.direction.round(6))) == towards


def test_texels_of_a_cell_are_one_sun() -> None:
    """Those of an environment that is not a whole number of cells wide, too."""
    light = np.full((600, 1202, 3), 0.1)
    light[300:302, 400:402] = 5000.0, 3000.0, 1000.0
    light[599, 1201] = 1e6
    suns = find_suns(light)
    assert len(suns) == 2
    solid_angle = equirect.texel_solid_angle(1202, 600)[..., None]
    taken = np.sum((light - 0.1) * solid_angle, axis=(0, 1))
    np.testing.assert_allclose(suns.irradiance.sum(axis=0), taken)
    middle = equirect.direction_from_uv(np.array([401.0 / 1202, 301.0 / 600]))
    np.testing.assert_allclose((suns.direction @ middle).max(), 1.0, atol=1e-9)


def test_a_kernel_shows_a_sun_of_several_texels_as_the_sum_over_them() -> None:
    light = np.full((600, 1202, 3), 0.1)
    light[300:302, 400:402] = 5000.0, 3000.0, 1000.0
    suns, bank = find_suns(light), KernelBank((1e4,))
    texels = equirect.direction_from_uv(texel_centres(1202, 600))[300:302, 400:402].reshape(-1, 3)
    across = normalize(np.cross(suns.direction[0], [0.0, 0.0, 1.0]))
    angle = np.linspace(0.0, 0.03, 7)[:, None]
    axis = np.cos(angle) * suns.direction[0] + np.sin(angle) * across

    def shown(kernel: KernelBank, towards: np.ndarray) -> np.ndarray:
        between = axis - towards
        return kernel.values(0.25 * dot(between, between))[:, 0]

    expected = np.mean([shown(bank, texel) for texel in texels], axis=0)
    wide, narrow = (shown(kernel, suns.direction[0]) for kernel in (suns.widened(bank), bank))
    # Two texels along each axis are no Gaussian: half the square of .07, their variance over the kernel's
    np.testing.assert_allclose(wide, expected, atol=2.5e-3 * expected.max())
    assert np.abs(narrow - expected).max() > 0.05 * expected.max()


def test_the_brightest_lamps_are_suns() -> None:
    direction = normalize(np.random.default_rng(6).normal(size=(MOST_SUNS + 3, 3)))
    irradiance = np.arange(1.0, MOST_SUNS + 4.0)[:, None] * [1.0, 0.5, 0.2]
    suns = lamp_suns(direction, irradiance, 0.01)
    np.testing.assert_array_equal(suns.direction, direction[:2:-1])
    np.testing.assert_array_equal(suns.irradiance, irradiance[:2:-1])


@pytest.mark.parametrize("light", [np.zeros((16, 32, 3)), np.ones((16, 32, 3)), sky(1.0)])
def test_light_that_no_few_places_hold_has_no_suns(light: np.ndarray) -> None:
    assert find_suns(light) is NO_SUNS


def test_without_suns_no_lobe_has_a_share_of_a_mirror() -> None:
    np.testing.assert_array_equal(NO_SUNS.mirror_share(np.array([1e-6, 0.01, 1.0])), 0.0)


def test_more_lamps_than_suns_are_left_to_lobes() -> None:
    light = sky()
    light[40, :: WIDTH // (4 * MOST_SUNS)] = 4000.0
    assert find_suns(light) is NO_SUNS


def test_maps_without_suns_are_those_of_light_without_suns() -> None:
    """Of each kernel, in closed form from what has been filtered with the suns."""
    without = drain(bake_pyramid(np.minimum(sky(), find_suns(sky()).ceiling), 256)).pyramid
    assert len(without.suns) == 0
    for with_sun, taken, wanted in zip(pyramid().maps, pyramid().sunless, without.maps, strict=True):
        # Filters are good to 1e-5 of the root mean square, and a bound on all texels is some times that;
        # single precision to 6e-8 of the peak
        tolerance = 3e-4 * np.sqrt(np.mean(with_sun**2)) + 1e-6 * with_sun.max()
        assert np.abs(taken - wanted).max() < tolerance


@pytest.mark.parametrize("roughness", [0.15, 0.3])
def test_a_metal_is_nearer_to_the_sum_over_all_texels(roughness: float) -> None:
    cosine = np.array([0.3, 0.6, 0.9])
    gold = {"base_color": (1.0, 0.75, 0.3), "metallic": 1.0, "roughness": roughness}
    exact = ring_radiance(Principled(**gold), environment_about(sky(), FRAME), cosine)
    azimuth = np.pi * (1.0 - 2.0 * (np.arange(WIDTH) + 0.5) / WIDTH)
    sine = np.sqrt(1.0 - cosine**2)[:, None]
    normal = np.stack(
        np.broadcast_arrays(sine * np.cos(azimuth), sine * np.sin(azimuth), cosine[:, None]), axis=-1
    ).reshape(-1, 3)
    normal, surface = normal @ FRAME.T, Surface(**gold)
    view_dir = np.broadcast_to(FRAME[:, 2], normal.shape)
    errors = []
    for light in (pyramid(), replace(pyramid(), suns=NO_SUNS)):
        shown = principled_radiance(light, shipped_families(), surface, normal, view_dir)
        errors.append(np.sqrt(np.mean((shown - exact.reshape(-1, 3)) ** 2)))
    assert errors[0] < 0.25 * errors[1]


def one_sun(narrowest: float) -> Suns:
    return Suns(np.array([[0.0, 0.0, 1.0]]), np.full((1, 3), 2.0), np.zeros(3), narrowest)


@pytest.mark.parametrize("share", [0.25, 0.5, 1.0, 2.0])
def test_narrow_lobes_keep_a_suns_light_and_their_foot(share: float) -> None:
    """Seen from straight above, by normals around the view: what is not as in a mirror has its part of it."""
    narrowest = 0.02
    alpha = share * narrowest
    edges = np.tan(np.linspace(0.0, 0.49 * np.pi, 4001)) * narrowest
    angle = 0.5 * (edges[1:] + edges[:-1])
    angle, step = angle[angle < 0.3], np.diff(edges)[angle < 0.3]
    normal = np.stack([np.sin(angle), np.zeros_like(angle), np.cos(angle)], axis=-1)
    view_dir = np.broadcast_to([0.0, 0.0, 1.0], normal.shape)
    white = np.broadcast_to(schlick(1.0)[:, None], (len(angle), 5, 3))
    suns = one_sun(narrowest)
    shown = suns.glossy(np.full(len(angle), alpha), white, normal, view_dir)[:, 0]
    # A mirror turns light by twice its own angle
    light = np.sum(shown * 2.0 * np.pi * np.sin(2.0 * angle) * 2.0 * step)
    assert light == pytest.approx(2.0 * (1.0 - suns.mirror_share(np.array(alpha))), rel=0.02)
    foot = ggx_ndf(np.sin(angle[-1]) ** 2, alpha) / (4.0 * np.cos(angle[-1])) * 2.0
    assert shown[-1] == pytest.approx(foot, rel=0.02)


def test_a_mirror_shows_the_environment() -> None:
    normal = normalize(np.random.default_rng(3).normal(size=(4000, 3)) * [1.0, 1.0, 0.3] + [0.0, 0.0, 1.0])
    normal = np.vstack([normal, normalize(pyramid().suns.direction + [0.0, 0.0, 1.0])])
    view_dir = np.broadcast_to([0.0, 0.0, 1.0], normal.shape)
    facing = dot(normal, view_dir) > 0.05
    white = np.broadcast_to(schlick(1.0)[:, None], (facing.sum(), 5, 3))
    shown = shading._glossy(
        pyramid(), shipped_families(), np.zeros(facing.sum()), white, normal[facing], view_dir[facing]
    )
    expected = lookup(pyramid().mirror, reflect(view_dir, normal)[facing], OCTAHEDRAL)
    np.testing.assert_allclose(shown, expected, rtol=1e-6)
    assert expected.max() > 100.0


def test_a_rough_diffuse_surface_is_as_with_the_sun_in_its_lobes() -> None:
    """Lobes are broad here, and show little of themselves."""
    normal = normalize(np.random.default_rng(4).normal(size=(500, 3)))
    view_dir = normalize(np.random.default_rng(5).normal(size=(500, 3)))
    clay = Surface(specular_level=0.0, diffuse_roughness=1.0)
    shown, before = (
        principled_radiance(light, shipped_families(), clay, normal, view_dir)
        for light in (pyramid(), replace(pyramid(), suns=NO_SUNS))
    )
    assert np.sqrt(np.mean((shown - before) ** 2)) < 0.05 * np.sqrt(np.mean(before**2))
