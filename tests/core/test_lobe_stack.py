"""Lobe stacks: baked and shaded they are what their fit says of the environment."""

from dataclasses import replace

import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf.model import BrdfFunction
from rsibr.rsibr_addon.core.conventions import Array, texel_centres
from rsibr.rsibr_addon.core.errors import RangeError, ShapeError
from rsibr.rsibr_addon.core.geometry.directions import dot, normalize, reflect
from rsibr.rsibr_addon.core.geometry.lit_sphere import ring_radiance
from rsibr.rsibr_addon.core.kinds.lobe_stack.shading import StackLook, stack_radiance
from rsibr.rsibr_addon.core.kinds.lobe_stack.stack import LAYOUTS, LobeStack, stack_representation
from rsibr.rsibr_addon.core.kinds.lobe_stack.sunlight import take_suns_apart
from rsibr.rsibr_addon.core.lobes.bake import (
    ALLOWED_INTERPOLATION,
    SHARPER,
    SIZES,
    BakedStack,
    bake_stack,
    sharpest_resolved,
)
from rsibr.rsibr_addon.core.lobes.bank import KernelBank
from rsibr.rsibr_addon.core.lobes.fit import Fit
from rsibr.rsibr_addon.core.maps import equirect
from rsibr.rsibr_addon.core.progress import drain
from rsibr.tests.lobe_stacks import random_fit, random_stack

BROAD = KernelBank((0.5, 2.0, 8.0))
HEIGHT = 32
RNG = np.random.default_rng(12)
TEXELS = equirect.direction_from_uv(texel_centres(2 * HEIGHT, HEIGHT))
LIGHT = 0.5 + RNG.random((HEIGHT, 2 * HEIGHT, 3)) ** 4
LIGHT[9, 20] = 50.0


def baked(radiance: Array, fit: Fit, layout: str = "dual_paraboloid", size: int | None = 64) -> BakedStack:
    return drain(bake_stack(radiance, fit, layout, size))


def surface_points(count: int) -> tuple[Array, Array]:
    """Normals all around, and views from their front."""
    normal = normalize(RNG.normal(size=(count, 3)))
    view_dir = normalize(RNG.normal(size=(count, 3)))
    view_dir *= np.sign(dot(normal, view_dir))[:, None]
    return normal, view_dir


def sum_over_texels(fit: Fit, radiance: Array, normal: Array, view_dir: Array) -> Array:
    """The fit's own lobes against every texel, in the axes of `Fit.at`."""
    mu = float(normal @ view_dir)
    mirror_dir = reflect(view_dir, normal)
    x = normalize(mirror_dir - mu * normal)
    own = np.stack([x, np.cross(normal, x), normal])
    height, width = radiance.shape[:2]
    power = radiance * equirect.texel_solid_angle(width, height)[..., None]
    return np.sum(fit.evaluate(TEXELS @ own.T, mu) * power, axis=(0, 1))


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("shared", [False, True])
def test_a_stack_is_its_fit_at_the_elevations(layout: str, shared: bool) -> None:
    fit = random_fit(BROAD, shared=shared)
    found = baked(LIGHT, fit, layout, 128)
    for mu in fit.mu:
        normal = normalize(RNG.normal(size=3))
        across = normalize(np.cross(normal, RNG.normal(size=3)))
        view_dir = mu * normal + np.sqrt(1.0 - mu**2) * across
        expected = np.maximum(sum_over_texels(fit, LIGHT, normal, view_dir), 0.0)
        shaded = stack_radiance(found.stack, normal, view_dir, StackLook())
        # What bilinear lookups cost, on average; peaks may have a few times that.
        np.testing.assert_allclose(shaded, expected, atol=8.0 * found.interpolation * expected.max())


def test_between_elevations_profiles_are_mixed_about_one_axis() -> None:
    # With taps and scale alike at all elevations, what is linear in each is linear in all.
    fit = random_fit(BROAD)
    fit.scale[:] = fit.scale[:, :1]
    fit.taps[:] = fit.taps[:, :1]
    found = baked(LIGHT, fit, size=128)
    normal, view_dir = surface_points(20)
    shaded = stack_radiance(found.stack, normal, view_dir, StackLook())
    for n, v, radiance in zip(normal, view_dir, shaded, strict=True):
        expected = np.maximum(sum_over_texels(fit, LIGHT, n, v), 0.0)
        np.testing.assert_allclose(radiance, expected, atol=8.0 * found.interpolation * expected.max())


def test_even_light_gives_the_albedo() -> None:
    fit = random_fit(BROAD)
    stack = baked(np.ones((512, 1024, 3)), fit, size=16).stack
    normal = np.array([0.0, 0.0, 1.0])
    view_dir = np.stack([np.sqrt(1.0 - fit.mu**2), 0.0 * fit.mu, fit.mu], axis=-1)
    # Kernels integrate to 1. The sum over texels of half-width h is off by kappa h^2 / 6 = 1e-5 at most.
    np.testing.assert_allclose(
        stack_radiance(stack, normal, view_dir, StackLook()), fit.albedo.sum(axis=0), rtol=1e-5
    )


def test_a_lobe_that_is_radial_is_the_true_brdf() -> None:
    """One lobe, as narrow as its light is smooth, against the sum over all texels of the BRDF itself."""
    kappa, mu = 60.0, 0.8
    bank = KernelBank((kappa,))
    one = np.ones((1, 1, 3))
    fit = Fit(
        "vMF",
        "single",
        np.array([mu]),
        bank,
        np.ones((1, 1, 1, 3)),
        one,
        np.zeros((1, 1, 1, 2)),
        one[..., :1],
    )
    radiance = np.exp(TEXELS @ RNG.normal(size=(3, 3)))
    found = baked(radiance, fit, size=128)
    expected = ring_radiance(_radial_brdf(bank), radiance, [mu])[0]
    normal = _ring_normals(mu, 2 * HEIGHT)
    shaded = stack_radiance(found.stack, normal, (0.0, 0.0, 1.0), StackLook())
    # Below the horizon, 53 degrees from the axis, lies exp(60 (cos 53 - 1)) = 4e-11 of the lobe.
    np.testing.assert_allclose(shaded, expected, rtol=10.0 * found.interpolation)
    assert found.interpolation < 1e-3


def _radial_brdf(bank: KernelBank) -> BrdfFunction:
    def brdf(light_dir: Array, view_dir: Array) -> Array:
        mirror_dir = view_dir * (-1.0, -1.0, 1.0)
        value = bank.values(0.5 * (1.0 - light_dir @ mirror_dir))
        above = light_dir[..., 2:] > 0.0
        return np.where(above, value / np.where(above, light_dir[..., 2:], 1.0), 0.0) * np.ones(3)

    return brdf


def _ring_normals(mu: float, width: int) -> Array:
    azimuth = np.pi * (1.0 - 2.0 * (np.arange(width) + 0.5) / width)
    radius = np.sqrt(1.0 - mu**2)
    return np.stack([radius * np.cos(azimuth), radius * np.sin(azimuth), np.full(width, mu)], axis=-1)


def test_no_texel_is_further_off_than_promised() -> None:
    fit = random_fit(BROAD)
    found = baked(LIGHT, fit, size=16)
    texels = found.stack.representation.texel_directions(16)
    power = LIGHT * equirect.texel_solid_angle(2 * HEIGHT, HEIGHT)[..., None]
    chord = texels[:, ::5, ::5, None, None] - TEXELS
    kernels = BROAD.values(0.25 * dot(chord, chord))
    exact = np.einsum("lpkc,sijabk,abc->lpsijc", fit.weights, kernels, power)
    error = np.abs(found.stack.maps[:, :, :, ::5, ::5] - exact).max(axis=(0, 1, 2, 3, 4))
    assert np.all(error <= found.bound + np.abs(exact).max() * 2.0**-24)
    # And the promise means something
    assert np.all(found.bound < 1e-4 * np.abs(exact).max())


@pytest.mark.parametrize("layout", LAYOUTS)
def test_lookups_cost_what_is_expected(layout: str) -> None:
    bank = KernelBank((30.0,))
    fit = random_fit(bank, lobes=1, taps=1)
    fit.scale[:], fit.taps[:], fit.weights[:] = 1.0, 1.0, 1.0
    fine, coarse = (baked(LIGHT, fit, layout, size) for size in (256, 32))
    normal, view_dir = surface_points(4000)
    expected = stack_radiance(fine.stack, normal, view_dir, StackLook())
    error = stack_radiance(coarse.stack, normal, view_dir, StackLook()) - expected
    seen = np.sqrt(np.mean(error**2) / np.mean(expected**2))
    # One environment is no average of all
    assert seen == pytest.approx(coarse.interpolation, rel=0.35)


def test_the_size_follows_from_the_lobes() -> None:
    sizes = []
    for kappa in (2.0, 20.0, 80.0):
        fit = random_fit(KernelBank((kappa,)), lobes=1, taps=1)
        found = baked(LIGHT, fit, size=None)
        assert found.interpolation <= ALLOWED_INTERPOLATION
        sizes.append(found.stack.size)
    assert sizes[0] < sizes[1] < sizes[2]
    assert set(sizes) <= set(SIZES)


def test_lobes_can_be_shown_alone() -> None:
    stack = random_stack("octahedral")
    stack.maps[:] = np.abs(stack.maps)
    normal, view_dir = surface_points(50)
    alone = [stack_radiance(stack, normal, view_dir, StackLook((lobe,))) for lobe in range(3)]
    np.testing.assert_allclose(stack_radiance(stack, normal, view_dir, StackLook()), sum(alone), rtol=1e-12)
    with pytest.raises(RangeError, match="no lobe 3: choose from 0 to 2"):
        stack_radiance(stack, normal, view_dir, StackLook((3,)))


@pytest.mark.parametrize("layout", LAYOUTS)
def test_shading_is_continuous_where_the_view_is_along_the_normal(layout: str) -> None:
    stack = random_stack(layout)
    normal = np.array([0.36, 0.48, 0.8])
    away = 1e-6 * np.stack([np.cos(np.arange(12.0)), np.sin(np.arange(12.0)), np.zeros(12)], axis=-1)
    around = stack_radiance(stack, normal, normalize(normal + away), StackLook())
    # Texels differ by 1, sixteen of them over the map; three lobes of two taps turn by 1e-6 each.
    assert np.abs(around - stack_radiance(stack, normal, normal, StackLook())).max() < 6 * 3e-5


def sunny() -> Array:
    """Smooth light, and two suns that hold nearly all of its squared radiance."""
    radiance = np.exp(TEXELS @ np.array([[0.5, -0.3, 0.9], [0.2, 0.8, -0.1], [-0.4, 0.3, 0.6]]))
    radiance[9, 20], radiance[22, 51] = (900.0, 700.0, 400.0), (300.0, 500.0, 600.0)
    return radiance


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("shared", [False, True])
def test_suns_are_seen_through_lobes_sharper_than_maps(layout: str, shared: bool) -> None:
    """Kernels up to four times as sharp as the light resolves."""
    radiance, rng = sunny(), np.random.default_rng(3)
    fit = random_fit(KernelBank((2.0, 256.0, SHARPER * sharpest_resolved(HEIGHT))), shared=shared)
    found = baked(radiance, fit, layout, 128)
    assert found.sharpest < fit.bank.concentrations[-2]
    stack = found.stack
    texel_dir = stack.representation.texel_directions(stack.size)
    sunlight = take_suns_apart(stack.maps, texel_dir, fit, found.sharpest, radiance)
    assert len(sunlight.suns) == 2
    apart = replace(stack, sunlight=sunlight)
    for mu in fit.mu:
        for sun in sunlight.suns.direction:
            # A view that mirrors the sun, within what offsets turn lobes by
            mirror_dir = normalize(sun + 0.1 * rng.normal(size=3))
            across = normalize(np.cross(mirror_dir, rng.normal(size=3)))
            normal = mu * mirror_dir + np.sqrt(1.0 - mu**2) * across
            view_dir = reflect(mirror_dir, normal)
            expected = np.maximum(sum_over_texels(fit, radiance, normal, view_dir), 0.0)
            shaded = stack_radiance(apart, normal, view_dir, StackLook())
            # Beside suns, the kernel in the maps is broader than two by a variance of 1 / 256 to 1 / 128,
            # times the light's curvature of about 3 and taps and weights that sum to 4
            np.testing.assert_allclose(shaded, expected, rtol=5e-3, atol=0.1)


def test_too_narrow_lobes_are_refused_with_the_remedy() -> None:
    with pytest.raises(
        RangeError, match=r"too coarse for some lobes of the fit\. Lobe 1 is .* or use a larger map"
    ):
        baked(LIGHT, random_fit(KernelBank((5000.0,))))


@pytest.mark.parametrize(
    ("layout", "size", "complaint"),
    [
        ("sphere_map", 64, "cannot be laid out as sphere_map: choose one of dual_paraboloid, octahedral"),
        ("octahedral", 1, "cannot be 1 texels wide: choose 2 to 1024"),
        ("octahedral", 4096, "cannot be 4096 texels wide: choose 2 to 1024"),
    ],
)
def test_layouts_and_sizes_have_limits(layout: str, size: int, complaint: str) -> None:
    with pytest.raises(RangeError, match=complaint):
        stack_representation(layout, size)


def test_stacks_are_checked() -> None:
    stack = random_stack("octahedral")
    whole = vars(stack)
    with pytest.raises(ShapeError, match="scale of a lobe stack cannot have the shape"):
        LobeStack(**{**whole, "scale": stack.scale[:, :4]})
    with pytest.raises(ShapeError, match="maps of a lobe stack cannot have the shape"):
        LobeStack(**{**whole, "maps": stack.maps[:, :3]})
    with pytest.raises(RangeError, match="ascend"):
        LobeStack(**{**whole, "mu": stack.mu[::-1]})
