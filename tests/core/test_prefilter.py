"""Filtered environments against brute force, their promised bounds, and what must hold of any filter."""

import functools
import itertools

import numpy as np
import pytest
from rsibr.rsibr_addon.core.conventions import Array, texel_centres
from rsibr.rsibr_addon.core.errors import RangeError, ShapeError
from rsibr.rsibr_addon.core.filtering.harmonics.analysis import analyse_environment
from rsibr.rsibr_addon.core.filtering.harmonics.coefficients import EnvironmentHarmonics
from rsibr.rsibr_addon.core.filtering.prefilter import (
    Prefiltered,
    analysis_degree,
    prefilter,
    prefilter_exact,
)
from rsibr.rsibr_addon.core.filtering.radial_lobes import (
    cosine_lobe,
    ggx_lobe,
    ggx_n_dot_l_lobe,
    von_mises_fisher_lobe,
)
from rsibr.rsibr_addon.core.filtering.zonal import ZonalLobe, expand
from rsibr.rsibr_addon.core.maps import equirect

RNG = np.random.default_rng(21)
LOBES = [ggx_lobe(0.1), von_mises_fisher_lobe(40.0), ggx_lobe(0.5), von_mises_fisher_lobe(300.0)]


def hdr_map(height: int = 48) -> Array:
    """A dim, uneven sky with a lamp and a sun of one texel, which holds half of all light."""
    radiance = 0.01 + 0.2 * RNG.random((height, 2 * height, 3)) ** 6
    radiance[height // 5, height // 3] = [30.0, 20.0, 5.0]
    radiance[3 * height // 4, height] = [3000.0, 2500.0, 2000.0]
    return radiance


def paraboloids(size: int) -> Array:
    """Directions of two paraboloid maps, corners included, shape (2, size, size, 3)."""
    centres = (2.0 * np.arange(size) + 1.0) / size - 1.0
    s, t = np.meshgrid(centres, centres)
    up = np.stack([2.0 * s, 2.0 * t, 1.0 - s**2 - t**2], axis=-1) / (1.0 + s**2 + t**2)[..., None]
    return np.stack([up, up * [1.0, 1.0, -1.0]])


POLES_AND_SEAM = np.array(
    [[0, 0, 1], [0, 0, -1], [-1, 0, 0], [-1, -1e-15, 0], [-1, 1e-15, 0], [1e-9, 0, 1.0]]
)
DIRECTIONS = np.concatenate([paraboloids(12).reshape(-1, 3), POLES_AND_SEAM])


def filtered(radiance: Array, lobes: list[ZonalLobe], directions: Array, tolerance: float) -> Prefiltered:
    series = [expand(lobe, tolerance) for lobe in lobes]
    return prefilter(analyse_environment(radiance, analysis_degree(series)), series, directions)


def white(degree: int) -> EnvironmentHarmonics:
    """Radiance 1 from everywhere: the integral, as no sum over texels is."""
    coefficients = np.zeros((1, (degree + 1) * (degree + 2) // 2), dtype=np.complex128)
    coefficients[0, 0] = np.sqrt(4.0 * np.pi)
    return EnvironmentHarmonics(coefficients, np.array([4.0 * np.pi]), degree, 512)


HEIGHT = 32
LIGHTS = {
    "hdr": hdr_map(HEIGHT),
    "sun alone": np.pad(np.full((1, 1, 2), 1e5), ((20, HEIGHT - 21), (30, 2 * HEIGHT - 31), (0, 0))),
    "noise": RNG.random((HEIGHT, 2 * HEIGHT, 1)),
}
SPHERE = equirect.direction_from_uv(texel_centres(96, 48))
SPHERE_WEIGHT = equirect.texel_solid_angle(96, 48)[None, ..., None] / (4.0 * np.pi)
WIDE = [ggx_lobe(0.1), von_mises_fisher_lobe(40.0), ggx_lobe(0.5), von_mises_fisher_lobe(150.0)]


@functools.cache
def exact_sphere(name: str) -> Array:
    return prefilter_exact(LIGHTS[name], WIDE, SPHERE)


@pytest.mark.slow
@pytest.mark.parametrize("tolerance", [1e-3, 1e-5, 1e-6, 1e-7, 1e-10])
@pytest.mark.parametrize("name", LIGHTS)
def test_the_promise_is_kept_against_brute_force(name: str, tolerance: float) -> None:
    found = filtered(LIGHTS[name], WIDE, SPHERE, tolerance)
    exact = exact_sphere(name)
    error = np.abs(found.radiance - exact)
    worst = error.max(axis=(1, 2))
    assert np.all(worst <= found.bound)
    rms = np.sqrt((SPHERE_WEIGHT * error**2).sum(axis=(1, 2)) / (SPHERE_WEIGHT * exact**2).sum(axis=(1, 2)))
    assert np.all(rms <= tolerance)
    assert np.all(worst <= 3.0 * tolerance * exact.max(axis=(1, 2)))
    assert np.all(found.radiance >= 0.0)
    # A promise a thousand times too cautious would be no use. At 1e-10 rounding is part of it.
    if tolerance > 1e-9:
        assert np.all(found.bound <= 30.0 * worst)


@pytest.mark.slow
@pytest.mark.parametrize("alpha", [0.0028, 0.0042, 0.02])
def test_the_narrowest_lobes_keep_the_promise(alpha: float) -> None:
    # From three rows wide, the least of a map with 512, in texels of light and dark, with a sun among them
    radiance = RNG.random((512, 1024, 1)) ** 6
    radiance[300, 700] = 1e4
    sun = equirect.direction_from_uv(texel_centres(1024, 512)[300, 700])
    nearby = sun + alpha * RNG.normal(size=(6, 3))
    directions = np.concatenate([RNG.normal(size=(3, 3)), POLES_AND_SEAM[:4], [sun], nearby])
    lobe = ggx_n_dot_l_lobe(alpha)
    found = filtered(radiance, [lobe], directions, 1e-4)
    exact = prefilter_exact(radiance, [lobe], directions)
    worst = np.abs(found.radiance - exact).max()
    assert worst <= found.bound
    assert worst <= 3e-4 * exact.max()


def test_dark_texels_beside_a_sun() -> None:
    radiance = np.full((64, 128, 1), 1e-4)
    radiance[40, 60] = 1e6
    lobe = von_mises_fisher_lobe(100.0)
    found = filtered(radiance, [lobe], DIRECTIONS, 1e-7)
    exact = prefilter_exact(radiance, [lobe], DIRECTIONS)
    assert exact.min() < 1e-6 * exact.max()
    assert found.radiance.min() >= 0.0
    # Everywhere, the darkest included, the error stays below 1e-7 of the sun's own peak.
    assert np.abs(found.radiance - exact).max() < 5e-7 * exact.max()


@pytest.mark.slow
@pytest.mark.parametrize(
    "lobe", [*LOBES, ggx_lobe(1.0), von_mises_fisher_lobe(1e-3)], ids=lambda lobe: f"{lobe.knots[1]:.2g}"
)
def test_a_white_furnace(lobe: ZonalLobe) -> None:
    series = [expand(lobe)]
    np.testing.assert_allclose(
        prefilter(white(series[0].degree), series, DIRECTIONS).radiance, 1.0, rtol=1e-10
    )
    # As points, the texels' sum is not quite the integral, but it is brute force's.
    radiance = np.full((64, 128, 3), 0.7)
    points = filtered(radiance, [lobe], DIRECTIONS, 1e-12)
    np.testing.assert_allclose(points.radiance, prefilter_exact(radiance, [lobe], DIRECTIONS), rtol=1e-10)


def test_a_white_furnace_with_kinks() -> None:
    for lobe, expected in ((cosine_lobe(), np.pi), (ggx_n_dot_l_lobe(0.2), 1.0)):
        series = [expand(lobe, 1e-2)]
        found = prefilter(white(series[0].degree), series, DIRECTIONS)
        np.testing.assert_allclose(found.radiance, expected, rtol=1e-10)


def test_a_lit_texel_gives_back_the_profile() -> None:
    radiance = np.zeros((48, 96, 1))
    radiance[25, 33] = 1.0 / equirect.texel_solid_angle(96, 48)[25, 33]
    axis = equirect.direction_from_uv([33.5 / 96, 25.5 / 48])
    angle = np.arccos(np.clip(DIRECTIONS @ axis, -1.0, 1.0))
    found = filtered(radiance, LOBES, DIRECTIONS, 1e-9)
    for lobe, values in zip(LOBES, found.radiance[..., 0], strict=True):
        profile = lobe.profile(angle)
        np.testing.assert_allclose(values, profile, rtol=0, atol=1e-8 * profile.max())


@pytest.mark.slow
def test_filtering_is_linear_and_turns_with_the_map() -> None:
    first, second = hdr_map(), RNG.random((48, 96, 3))
    mixed = filtered(2.0 * first + second, LOBES, DIRECTIONS, 1e-9).radiance
    apart = [filtered(radiance, LOBES, DIRECTIONS, 1e-9).radiance for radiance in (first, second)]
    np.testing.assert_allclose(mixed, 2.0 * apart[0] + apart[1], rtol=0, atol=1e-8 * mixed.max())
    # 24 of 96 columns to the right are a quarter turn clockwise, seen from above.
    turned = filtered(np.roll(first, 24, axis=1), LOBES, DIRECTIONS, 1e-9).radiance
    back = DIRECTIONS @ np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    np.testing.assert_allclose(
        turned, filtered(first, LOBES, back, 1e-9).radiance, rtol=0, atol=1e-8 * turned.max()
    )


def test_no_slice_knows_the_others() -> None:
    radiance = hdr_map()
    series = [expand(ggx_lobe(alpha)) for alpha in np.geomspace(0.09, 1.0, 9)]
    harmonics = analyse_environment(radiance, analysis_degree(series) + 7)
    together = prefilter(harmonics, series, DIRECTIONS)
    for i in range(len(series)):
        alone = prefilter(harmonics, series[i : i + 1], DIRECTIONS)
        assert alone.degrees[0] == together.degrees[i]
        slack = (alone.bound[0] + together.bound[i])[None]
        assert np.all(np.abs(alone.radiance[0] - together.radiance[i]) <= slack)
    # Wider lobes need less, so they are cut sooner.
    assert all(a >= b for a, b in itertools.pairwise(together.degrees))


def test_signed_lobes_may_give_negative_radiance() -> None:
    def ripple(angle: Array) -> Array:
        return np.exp(-10.0 * angle**2) * np.cos(8.0 * angle)

    lobe = ZonalLobe(ripple, (0.0, 0.5, 1.5, np.pi))
    radiance = hdr_map(32)
    found = filtered(radiance, [lobe], DIRECTIONS, 1e-6)
    exact = prefilter_exact(radiance, [lobe], DIRECTIONS)
    assert exact.min() < -0.01 * exact.max()
    assert np.all(np.abs(found.radiance - exact).max(axis=1) <= found.bound)


def test_shapes() -> None:
    radiance = RNG.random((32, 64, 2))
    directions = paraboloids(4)
    found = filtered(radiance, LOBES[:2], directions, 1e-4)
    assert found.radiance.shape == (2, *directions.shape[:-1], 2)
    assert found.bound.shape == (2, 2)
    assert len(found.degrees) == 2
    one = filtered(radiance, LOBES[:2], directions[1, 2, 3], 1e-4)
    np.testing.assert_allclose(one.radiance, found.radiance[:, 1, 2, 3], rtol=1e-12)
    longer = filtered(radiance, LOBES[:2], 5.0 * directions, 1e-4)
    np.testing.assert_allclose(longer.radiance, found.radiance, rtol=1e-9)
    assert filtered(radiance, LOBES[:2], np.zeros((0, 3)), 1e-4).radiance.shape == (2, 0, 2)


def test_black_stays_black() -> None:
    found = filtered(np.zeros((24, 48, 3)), LOBES[:3], DIRECTIONS, 1e-6)
    assert np.all(found.radiance == 0.0)
    assert np.all(found.bound == 0.0)


def test_what_cannot_be_filtered_is_refused() -> None:
    series = [expand(ggx_lobe(0.5)), expand(ggx_lobe(0.05))]
    small = analyse_environment(np.ones((16, 32, 3)), analysis_degree(series))
    with pytest.raises(
        RangeError, match=r"Lobe 2 is 19\.8 degrees wide, and a map of 16 rows resolves 33\.8"
    ):
        prefilter(small, series, DIRECTIONS)
    known = analyse_environment(np.ones((64, 128, 3)), series[0].degree)
    with pytest.raises(RangeError, match=f"Lobe 2 needs harmonics up to degree {series[1].degree}"):
        prefilter(known, series, DIRECTIONS)
    prefilter(known, series[:1], DIRECTIONS)
    for bad in (np.nan, np.inf):
        with pytest.raises(RangeError, match="NaN or infinite"):
            prefilter(known, series[:1], [0.0, bad, 1.0])
    for directions in (np.ones((4, 2)), 3.0):
        with pytest.raises(ShapeError, match="three components"):
            prefilter(known, series[:1], directions)
