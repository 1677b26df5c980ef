"""Spherical harmonics against their definitions: sums over texels, the addition theorem, plain series."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.conventions import Array, texel_centres
from rsibr.rsibr_addon.core.errors import RangeError, ShapeError
from rsibr.rsibr_addon.core.filtering.harmonics.analysis import analyse_environment
from rsibr.rsibr_addon.core.filtering.harmonics.coefficients import EnvironmentHarmonics
from rsibr.rsibr_addon.core.filtering.harmonics.kernel import WIDEST, Kernel, kernels_for
from rsibr.rsibr_addon.core.filtering.harmonics.legendre import MAX_DEGREE, legendre_panels
from rsibr.rsibr_addon.core.filtering.harmonics.rings import (
    fast_even,
    moment_matching_rings,
    ring_colatitudes,
    ring_resampler,
)
from rsibr.rsibr_addon.core.filtering.harmonics.synthesis import grid_rows, synthesise, synthesise_directly
from rsibr.rsibr_addon.core.filtering.irradiance import real_harmonics
from rsibr.rsibr_addon.core.maps import equirect

RNG = np.random.default_rng(11)
MAP = RNG.random((12, 24, 3)) ** 4
EVERYWHERE = np.concatenate(
    [
        RNG.normal(size=(200, 3)),
        [[0, 0, 1], [0, 0, -1], [1, 0, 0], [-1, 0, 0], [-1, -1e-12, 0], [1e-9, 0, 1], [0, 1e-9, -1]],
    ]
)
THETA = np.arctan2(np.hypot(EVERYWHERE[:, 0], EVERYWHERE[:, 1]), EVERYWHERE[:, 2])
PHI = np.arctan2(EVERYWHERE[:, 1], EVERYWHERE[:, 0]) % (2.0 * np.pi)
UNIT = EVERYWHERE / np.linalg.norm(EVERYWHERE, axis=1, keepdims=True)


def power_at_points(degree: int, theta: Array, degrees: Array) -> Array:
    """Sum over m of |lambda_lm|^2 for some degrees l, analysed up to `degree`, shape (degrees, points)."""
    power = np.zeros((len(degrees), len(theta)))
    for panel in legendre_panels(degree, np.cos(theta), np.sin(theta)):
        m = panel.first_order + np.arange(panel.values.shape[1])
        for sums, degree_l in zip(power, degrees, strict=True):
            row = degree_l - m - panel.first_row
            here = np.flatnonzero((row >= 0) & (row < len(panel.values)))
            values = panel.factors[row[here], here, None] * panel.values[row[here], here]
            sums[panel.first_point :] += np.where(m[here] == 0, 1.0, 2.0) @ values**2
    return power


@pytest.mark.parametrize("degree", [0, 1, 2, 63, 64, 65, 300, 2000])
def test_legendre_functions_obey_the_addition_theorem(degree: int) -> None:
    theta = np.array([0.0, 1e-9, 1e-4, 0.01, 0.05, 0.1, 0.37, 0.8, 1.2, 1.5, np.pi / 2])
    degrees = np.unique(np.array([0, 1, 2, 37, 64, 299, degree - 1, degree]).clip(0, degree))
    expected = (2 * degrees + 1) / (4.0 * np.pi)
    # The recurrence rounds in every step, and near the poles each error grows like the steps after it.
    tolerance = np.finfo(float).eps * (degree**2 + 10)
    power = power_at_points(degree, theta, degrees)
    np.testing.assert_allclose(power / expected[:, None], 1.0, rtol=0, atol=tolerance)


def test_no_value_underflows_up_to_the_largest_degree() -> None:
    # Where turning points have the smallest seeds: sin(theta) = 1 / e (docs/prefiltering.md, section 4).
    theta = np.array([0.03, np.arcsin(np.exp(-1.0)), 0.9])
    power = power_at_points(MAX_DEGREE, theta, np.array([MAX_DEGREE]))
    tolerance = np.finfo(float).eps * MAX_DEGREE**2
    np.testing.assert_allclose(power, (2 * MAX_DEGREE + 1) / (4.0 * np.pi), rtol=tolerance)


@pytest.mark.parametrize(("height", "width"), [(12, 24), (5, 7), (1, 2), (9, 4)])
@pytest.mark.parametrize("degree", [0, 1, 2, 20, 33])
def test_analysis_is_the_sum_over_texels(height: int, width: int, degree: int) -> None:
    radiance = RNG.random((height, width, 2)) - 0.3
    harmonics = analyse_environment(radiance, degree)
    texels = equirect.direction_from_uv(texel_centres(width, height))
    light = radiance * equirect.texel_solid_angle(width, height)[..., None]
    expected = np.einsum("jik,jic->kc", real_harmonics(texels, degree), light)
    # The sum of about 4 pi texel weights, each rounded, times harmonics up to sqrt(2 degree + 1).
    np.testing.assert_allclose(harmonics.real(degree), expected, rtol=0, atol=1e-13)
    np.testing.assert_allclose(harmonics.flux, np.abs(light).sum(axis=(0, 1)), rtol=1e-14)
    power = np.add.reduceat(expected**2, np.arange(degree + 1) ** 2, axis=0)
    np.testing.assert_allclose(harmonics.power(), power, rtol=0, atol=1e-12)


def test_areas_do_not_change_when_texels_are_split() -> None:
    split = np.repeat(np.repeat(MAP, 3, axis=0), 2, axis=1)
    whole = analyse_environment(MAP, 40, texels="areas").real(40)
    np.testing.assert_allclose(analyse_environment(split, 40, texels="areas").real(40), whole, atol=1e-13)
    # As points they do change: the identity above is not that of any quadrature.
    assert (
        np.abs(analyse_environment(split, 40).real(40) - analyse_environment(MAP, 40).real(40)).max() > 1e-3
    )


def test_areas_of_a_constant_are_its_mean_alone() -> None:
    coefficients = analyse_environment(np.full((6, 12, 1), 3.0), 50, texels="areas").real(50)
    np.testing.assert_allclose(coefficients[0], 3.0 * np.sqrt(4.0 * np.pi), rtol=1e-15)
    np.testing.assert_allclose(coefficients[1:], 0.0, atol=1e-13)


def test_the_area_of_a_polar_row_in_closed_form() -> None:
    radiance = np.zeros((8, 16, 1))
    radiance[-1] = 1.0
    cosine = np.cos(np.pi / 8)
    found = analyse_environment(radiance, 2, texels="areas").by_order[0][:, 0].real
    moments = [1.0 - cosine, (1.0 - cosine**2) / 2, (cosine - cosine**3) / 2]
    expected = 2.0 * np.pi * np.array(moments) * np.sqrt(np.array([1.0, 3.0, 5.0]) / (4.0 * np.pi))
    np.testing.assert_allclose(found, expected, rtol=1e-13)


def test_turning_the_map_turns_the_phase() -> None:
    turned = analyse_environment(np.roll(MAP, 5, axis=1), 30)
    for m, (a, b) in enumerate(zip(analyse_environment(MAP, 30).by_order, turned.by_order, strict=True)):
        # Five columns to the right are phi less by 5 / 24 of a turn.
        np.testing.assert_allclose(b, a * np.exp(2j * np.pi * m * 5 / 24), atol=1e-13)


def test_what_cannot_be_analysed_is_refused() -> None:
    with pytest.raises(ShapeError, match="rows, columns and channels"):
        analyse_environment(MAP[..., 0], 4)
    for degree in (-1, MAX_DEGREE + 1):
        with pytest.raises(RangeError, match=f"Degree {degree} cannot"):
            analyse_environment(MAP, degree)
    for bad in (np.nan, np.inf):
        radiance = MAP.copy()
        radiance[3, 4, 1] = bad
        with pytest.raises(RangeError, match="NaN or infinite"), np.errstate(invalid="ignore"):
            analyse_environment(radiance, 4)


@pytest.mark.parametrize("least", [1, 2, 7, 97.2, 1201])
def test_fast_sizes(least: float) -> None:
    size = fast_even(least)
    assert least <= size <= 1.25 * least + 2
    assert size % 2 == 0
    assert 2**20 * 3**20 * 5**20 % size == 0


def trigonometric(degree: int, parity: int, theta: Array, factors: Array) -> Array:
    """A function of the colatitude that continues over the poles as (-1)^parity times itself."""
    k = np.arange(degree + 1)[:, None]
    return factors @ (np.sin(k * theta) if parity else np.cos(k * theta))


@pytest.mark.parametrize(("degree", "given", "made"), [(1, 2, 2), (9, 10, 12), (9, 12, 10), (30, 32, 40)])
def test_resampling_rings_is_exact(degree: int, given: int, made: int) -> None:
    factors = RNG.normal(size=(2, 3, degree + 1)) + 1j * RNG.normal(size=(2, 3, degree + 1))
    gains = RNG.random(degree + 1)
    rings, expected = (
        np.stack([trigonometric(degree, p, ring_colatitudes(n), f[p]) for p in (0, 1)])
        for n, f in ((given, factors), (made, factors * gains))
    )
    out = np.empty((2, 3, made), dtype=np.complex128)
    ring_resampler(given, made, gains)(rings, out)
    np.testing.assert_allclose(out, expected, atol=1e-13 * degree)


def test_few_rings_stand_for_many_rows() -> None:
    degree, count, height = 9, 12, 40
    rows = RNG.normal(size=(2, 2, 3, height)) + 1j * RNG.normal(size=(2, 2, 3, height))
    weights = moment_matching_rings(rows, degree, count, "points")
    measure = equirect.texel_solid_angle(1, height)[::-1, 0] / (2.0 * np.pi)
    for parity in (0, 1):
        factors = RNG.normal(size=(5, degree + 1))
        over_rings = weights[:, parity] @ trigonometric(degree, parity, ring_colatitudes(count), factors).T
        over_rows = (
            rows[:, parity] * measure @ trigonometric(degree, parity, ring_colatitudes(height), factors).T
        )
        np.testing.assert_allclose(over_rings, over_rows, atol=1e-13)


@pytest.mark.parametrize("width", [4, 5, 7, 8, 11])
def test_the_kernel_leaks_what_it_says(width: int) -> None:
    kernel = Kernel(width)
    position = RNG.uniform(0.0, 1.0, 500)
    taps = np.arange(-width, width + 2)
    frequency = np.linspace(0.0, 2.5, 40)
    distance = position[:, None] - taps
    weights = np.where(np.abs(distance) <= width / 2, kernel(distance), 0.0)
    found = np.exp(1j * frequency[:, None] * taps) @ weights.T / kernel.transform(frequency)[:, None]
    worst = np.abs(found - np.exp(1j * frequency[:, None] * position)).max(axis=1)
    # Between the positions that were tried, and beyond, 500 others are hardly ever worse.
    np.testing.assert_allclose(kernel.leakage(frequency), np.maximum.accumulate(worst), rtol=0.1, atol=1e-15)


def test_kernels_are_offered_from_the_narrowest_that_may_do() -> None:
    low = np.array([0.0, 0.3])
    for tolerance in (1e-3, 1e-5, 1e-7, 1e-10):
        widths = [kernel.width for kernel in kernels_for(tolerance)]
        assert widths == list(range(widths[0], WIDEST + 1))
        assert Kernel(widths[0]).leakage(low)[-1] < 2.0 * tolerance
        assert widths[0] == 4 or Kernel(widths[0] - 1).leakage(low)[-1] > 0.5 * tolerance
    assert [kernel.width for kernel in kernels_for(1e-30)] == [WIDEST]


@pytest.mark.parametrize("degree", [1, 2, 17, 40])
def test_synthesis_is_the_series(degree: int) -> None:
    harmonics = analyse_environment(MAP, degree)
    gains = RNG.normal(size=(2, degree + 1))
    per_order = np.repeat(gains, 2 * np.arange(degree + 1) + 1, axis=1)
    expected = np.einsum(
        "pk,sk,kc->psc", real_harmonics(UNIT, degree), per_order, harmonics.real(degree), optimize=True
    )
    directly = synthesise_directly(harmonics, gains, THETA, PHI)
    np.testing.assert_allclose(directly, expected, rtol=0, atol=1e-12)
    kernel = Kernel(8)
    leakage = kernel.leakage(np.arange(degree + 1) * np.pi / grid_rows(degree))
    allowed = 2.0 * (np.abs(gains) * leakage) @ harmonics.ceilings()[: degree + 1]
    error = np.abs(synthesise(harmonics, gains, THETA, PHI, kernel) - expected).max(axis=0)
    assert np.all(error <= allowed + 1e-12)


def test_the_mean_is_not_interpolated() -> None:
    harmonics = EnvironmentHarmonics((np.array([[5.0 + 0j]]), np.array([[0j]])), np.ones(1), 1)
    with pytest.raises(IndexError):
        harmonics.by_order[2]
    padded = analyse_environment(np.full((4, 8, 1), 5.0), 6, texels="areas")
    values = synthesise(padded, np.ones((1, 7)), THETA, PHI, Kernel(4))
    np.testing.assert_allclose(values, 5.0, rtol=1e-14)


def test_no_degree_exceeds_what_its_power_allows() -> None:
    harmonics = analyse_environment(MAP, 12)
    for degree in range(13):
        gains = (np.arange(13) == degree)[None].astype(float)
        values = np.abs(synthesise_directly(harmonics, gains, THETA, PHI)).max(axis=(0, 1))
        assert np.all(values <= harmonics.ceilings()[degree] * (1.0 + 1e-12))
