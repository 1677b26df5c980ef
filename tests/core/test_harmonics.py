"""Spherical harmonics against their definitions: sums over texels, the addition theorem, plain series."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.errors import RangeError, ShapeError
from rsibr.rsibr_addon.core.filtering.harmonics.analysis import MAX_DEGREE, analyse_environment
from rsibr.rsibr_addon.core.filtering.harmonics.legendre import legendre_series, legendre_sums
from rsibr.rsibr_addon.core.filtering.harmonics.synthesis import INTERPOLATION, synthesise
from rsibr.rsibr_addon.core.filtering.irradiance import real_harmonics
from rsibr.rsibr_addon.core.maps import equirect
from rsibr.rsibr_addon.core.threads import VARIABLE, thread_count

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
    np.testing.assert_allclose(harmonics.power, power, rtol=0, atol=1e-12)


def test_turning_the_map_turns_the_phase() -> None:
    given, turned = analyse_environment(MAP, 30), analyse_environment(np.roll(MAP, 5, axis=1), 30)
    for m in range(31):
        # Five columns to the right are phi less by 5 / 24 of a turn.
        phase = np.exp(2j * np.pi * m * 5 / 24)
        np.testing.assert_allclose(turned.order(m), given.order(m) * phase, atol=1e-13)


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


@pytest.mark.parametrize("degree", [1, 2, 17, 40])
def test_synthesis_is_the_series(degree: int) -> None:
    harmonics = analyse_environment(MAP, degree)
    gains = RNG.normal(size=degree + 1)
    per_order = np.repeat(gains, 2 * np.arange(degree + 1) + 1)
    expected = (real_harmonics(UNIT, degree) * per_order @ harmonics.real(degree)).T
    allowed = INTERPOLATION * np.abs(gains) @ harmonics.ceilings()[: degree + 1]
    error = np.abs(synthesise(harmonics, gains, THETA, PHI) - expected).max(axis=1)
    assert np.all(error <= allowed)


@pytest.mark.parametrize("degree", [100, 700, MAX_DEGREE])
def test_any_degree_obeys_the_addition_theorem(degree: int) -> None:
    # Three lit texels: the filtered map is the sum of three series of Legendre polynomials, without orders.
    height = 64
    radiance = np.zeros((height, 2 * height, 1))
    lit = np.array([[0, 5], [31, 77], [63, 127]])
    radiance[*lit.T, 0] = [3.0, 1.0, 2.0]
    light = radiance[..., 0] * equirect.texel_solid_angle(2 * height, height)
    gains = 0.999 ** np.arange(degree + 1)
    suns = equirect.direction_from_uv(texel_centres(2 * height, height)[*lit.T])
    cosine = np.clip(UNIT @ suns.T, -1.0, 1.0)
    series = (2 * np.arange(degree + 1) + 1) / (4.0 * np.pi) * gains
    expected = np.polynomial.legendre.legval(cosine, series) @ light[*lit.T]
    harmonics = analyse_environment(radiance, degree)
    values = synthesise(harmonics, gains, THETA, PHI)[0]
    allowed = INTERPOLATION * gains @ harmonics.ceilings()[:, 0]
    # Beside a pole of the series, rounding of the cosine alone moves a value by its slope, degree^2 times it.
    rounding = 1e-15 * degree**2 * np.abs(series).sum() * light.sum()
    np.testing.assert_allclose(values, expected, rtol=0, atol=allowed + rounding)


@pytest.mark.parametrize("degree", [0, 1, 2, 40, 300])
def test_legendre_polynomials_are_those_of_numpy(degree: int) -> None:
    weight, coefficients = RNG.normal(size=len(THETA)), RNG.normal(size=degree + 1)
    polynomials = np.polynomial.legendre.legvander(np.cos(THETA), degree)
    # No polynomial exceeds 1; numpy's recurrence loses its last digits step by step.
    rounding = 1e-15 * (degree + 1)
    np.testing.assert_allclose(
        legendre_sums(weight, THETA, degree),
        weight @ polynomials,
        rtol=0,
        atol=rounding * np.abs(weight).sum(),
    )
    np.testing.assert_allclose(
        legendre_series(coefficients, THETA),
        polynomials @ coefficients,
        rtol=0,
        atol=rounding * np.abs(coefficients).sum(),
    )


def test_legendre_polynomials_of_large_degree_are_orthogonal() -> None:
    degree = 3 * MAX_DEGREE // 2
    node, weight = np.polynomial.legendre.leggauss(64)
    # Panels of a thousandth of half a turn: 4.5 waves of a product of two, at 14 nodes a wave.
    theta = np.concatenate([(panel + 0.5 * (node + 1.0)) * np.pi / 1000 for panel in range(1000)])
    area = np.tile(weight, 1000) * 0.5 * np.pi / 1000 * np.sin(theta)
    for chosen in (degree, degree - 7):
        polynomial = legendre_series((np.arange(degree + 1) == chosen).astype(float), theta)
        expected = (np.arange(degree + 1) == chosen) * 2.0 / (2 * chosen + 1)
        # Phases of some 1e4 radians are rounded to 1e-12: as much of the largest sum, 2e-4.
        found = legendre_sums(area * polynomial, theta, degree)
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-14)


def test_the_mean_is_not_interpolated() -> None:
    padded = analyse_environment(np.full((4, 8, 1), 5.0), 0)
    values = synthesise(padded, np.ones(1), THETA, PHI)
    np.testing.assert_allclose(values, 5.0, rtol=1e-14)


def test_no_degree_exceeds_what_its_power_allows() -> None:
    harmonics = analyse_environment(MAP, 12)
    for degree in range(13):
        gains = (np.arange(13) == degree).astype(float)
        values = np.abs(synthesise(harmonics, gains, THETA, PHI)).max(axis=1)
        assert np.all(values <= harmonics.ceilings()[degree] * (1.0 + 1e-12))


def test_the_number_of_threads_changes_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    radiance = RNG.random((128, 256, 2))
    found = []
    for count in (1, 2, 5):
        monkeypatch.setenv(VARIABLE, str(count))
        harmonics = analyse_environment(radiance, 300)
        found.append((harmonics.coefficients, synthesise(harmonics, np.ones(301), THETA, PHI)))
    for coefficients, values in found[1:]:
        np.testing.assert_array_equal(coefficients, found[0][0])
        # One thread adds in another order than several: the last bits differ.
        np.testing.assert_allclose(values, found[0][1], rtol=0, atol=1e-14 * np.abs(values).max())


def test_what_is_no_number_of_threads_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(VARIABLE, "3")
    assert thread_count() == 3
    for said in ("0", "", "many", "-1", "1.5"):
        monkeypatch.setenv(VARIABLE, said)
        with pytest.raises(RangeError, match="set it to a number of threads"):
            thread_count()
    monkeypatch.delenv(VARIABLE)
    assert thread_count() >= 1
