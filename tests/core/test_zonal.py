"""Zonal coefficients against closed forms, Parseval's theorem and the lobes themselves."""

import dataclasses

import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import RangeError
from rsibr.rsibr_addon.core.filtering.harmonics.analysis import MAX_DEGREE
from rsibr.rsibr_addon.core.filtering.radial_lobes import (
    cosine_lobe,
    ggx_lobe,
    ggx_n_dot_l_lobe,
    phong_lobe,
    von_mises_fisher_lobe,
)
from rsibr.rsibr_addon.core.filtering.zonal import ZonalLobe, expand, graded_knots, zonal_coefficients

# Quadrature rounds sums of a thousand terms that are at most the lobe's integral.
ROUNDED = 1e-13

LOBES = {
    "cosine": cosine_lobe(),
    "ggx 0.02": ggx_lobe(0.02),
    "ggx 0.5": ggx_lobe(0.5),
    "ggx 1": ggx_lobe(1.0),
    "ggx n.l 0.1": ggx_n_dot_l_lobe(0.1),
    "ggx n.l 0.999999": ggx_n_dot_l_lobe(0.999999),
    "ggx n.l 1": ggx_n_dot_l_lobe(1.0),
    "phong 5": phong_lobe(5.0),
    "phong 6.5": phong_lobe(6.5),
    "phong 3000": phong_lobe(3000.0),
    "vmf 1e-3": von_mises_fisher_lobe(1e-3),
    "vmf 2": von_mises_fisher_lobe(2.0),
    "vmf 1e4": von_mises_fisher_lobe(1e4),
}


@pytest.mark.parametrize("name", LOBES)
def test_lobes_integrate_to_what_they_say(name: str) -> None:
    expected = np.pi if name == "cosine" else 1.0
    integral = zonal_coefficients(dataclasses.replace(LOBES[name], closed_form=None), 0)[0]
    assert integral == pytest.approx(expected, rel=ROUNDED)


@pytest.mark.parametrize("name", ["cosine", "vmf 1e-3", "vmf 2", "vmf 1e4"])
def test_closed_forms_are_the_integrals(name: str) -> None:
    by_quadrature = dataclasses.replace(LOBES[name], closed_form=None)
    for degree in (0, 1, 2, 3, 300):
        found = zonal_coefficients(LOBES[name], degree)
        assert found.shape == (degree + 1,)
        np.testing.assert_allclose(
            found, zonal_coefficients(by_quadrature, degree), rtol=0, atol=10 * ROUNDED
        )


def test_the_cosine_lobe_has_the_published_coefficients() -> None:
    expected = [np.pi, 2 * np.pi / 3, np.pi / 4, 0.0, -np.pi / 24, 0.0, np.pi / 64, 0.0, -np.pi / 128]
    np.testing.assert_allclose(zonal_coefficients(cosine_lobe(), 8), expected, rtol=1e-14, atol=0)


def test_first_coefficients_in_closed_form() -> None:
    # The mean cosine of a von Mises-Fisher lobe is coth(kappa) - 1 / kappa.
    for kappa in (0.5, 7.0, 300.0):
        p = zonal_coefficients(von_mises_fisher_lobe(kappa), 1)
        assert p[1] == pytest.approx(1.0 / np.tanh(kappa) - 1.0 / kappa, rel=1e-13)
    # GGX with u = (1 - cos) / 2 has density a / (a + (1 - a) u)^2 in u on [0, 1], a = alpha^2.
    for alpha in (0.01, 0.3):
        a = alpha**2
        mean_u = a / (1.0 - a) ** 2 * (-np.log(a) - 1.0 + a)
        assert zonal_coefficients(ggx_lobe(alpha), 1)[1] == pytest.approx(1.0 - 2.0 * mean_u, rel=1e-12)


@pytest.mark.parametrize("alpha", [0.05, 0.4])
def test_ggx_falls_as_its_nearest_singularity_says(alpha: float) -> None:
    # The pole at cos = (1 + a) / (1 - a) makes p_l fall like sqrt(l) ((1 - alpha) / (1 + alpha))^l.
    degree = int(6.0 / alpha)
    p = zonal_coefficients(ggx_lobe(alpha), degree)
    ratio = (1.0 - alpha) / (1.0 + alpha) * np.sqrt(degree / (degree - 1.0))
    assert p[-1] / p[-2] == pytest.approx(ratio, rel=1.0 / degree**2 + alpha**2 / 10)


@pytest.mark.parametrize("name", [n for n in LOBES if "n.l" not in n and n != "cosine"])
def test_a_series_is_its_lobe(name: str) -> None:
    series = expand(LOBES[name], 1e-10)
    assert series.lobe is LOBES[name]
    power = (2 * np.arange(series.degree + 1) + 1) * series.coefficients**2
    angle = np.linspace(0.0, np.pi, 100001)
    square = np.trapezoid(2.0 * np.pi * np.sin(angle) * LOBES[name].profile(angle) ** 2, angle)
    # The trapezoid rule errs by the square of its step over the lobe's width of at least .01.
    assert power.sum() / (4.0 * np.pi) == pytest.approx(square, rel=1e-5)
    peak = LOBES[name].profile(np.zeros(1))[0]
    assert series.truncation_errors(series.degree)[0] < 1e-10 * peak


@pytest.mark.parametrize("name", LOBES)
def test_truncation_errors_are_seen_and_never_above_the_sum_of_what_is_left_out(name: str) -> None:
    lobe = LOBES[name]
    series = expand(lobe, 1e-3)
    degrees = [1, series.degree // 2, series.degree]
    errors = series.truncation_errors(*degrees)
    many = zonal_coefficients(lobe, 8 * series.degree)
    sizes = (2 * np.arange(len(many)) + 1) / (4.0 * np.pi)
    angle = np.linspace(0.0, np.pi, 2001)
    for degree, error in zip(degrees, errors, strict=True):
        cut = np.polynomial.legendre.legval(np.cos(angle), (sizes * many)[: degree + 1])
        seen = np.abs(lobe.profile(angle) - cut).max()
        # 2001 angles miss the very top of waves that the series' own points meet, and the other way round.
        assert error == pytest.approx(seen, rel=0.05, abs=1e-12)
        if "n.l" not in name and name != "cosine":
            assert error <= (sizes * np.abs(many))[degree + 1 :].sum() * (1.0 + 1e-6) + 1e-12


def test_the_degree_follows_the_tolerance() -> None:
    previous = 0
    for tolerance in (1e-2, 1e-4, 1e-6, 1e-8):
        series = expand(ggx_lobe(0.1), tolerance)
        power = (2 * np.arange(series.degree + 1) + 1) * series.coefficients**2
        sufficient = int(series.degree * 3 / 4)
        assert np.sqrt(power[sufficient + 1 :].sum() / power.sum()) <= tolerance
        # Not much further than needed: a tenth less does not do.
        assert np.sqrt(power[int(0.9 * sufficient) :].sum() / power.sum()) > tolerance
        assert series.degree > previous
        previous = series.degree
        assert series.tolerance == tolerance


def test_widths() -> None:
    for width in (0.3, 2.0):

        def disk(angle: np.ndarray, edge: float = width / 2) -> np.ndarray:
            return np.where(angle < edge, 5.0, 0.0)

        knots = (0.0, width / 2, np.pi)
        # A disk's edge is not smooth: all that can be asked for is little.
        assert expand(ZonalLobe(disk, knots), 0.1).width == pytest.approx(width, rel=1e-6)
    # A narrow Gaussian exp(-kappa angle^2 / 2): solid angle 4 pi / kappa, so 4 / sqrt(kappa) across.
    assert expand(von_mises_fisher_lobe(1e4)).width == pytest.approx(0.04, rel=1e-3)
    assert expand(ggx_lobe(1.0)).width == pytest.approx(2.0 * np.pi, rel=1e-6)


def test_signs_are_found() -> None:
    assert not expand(cosine_lobe(), 1e-2).signed
    ripple = ZonalLobe(lambda angle: np.cos(3.0 * angle), (0.0, np.pi))
    assert expand(ripple).signed


def test_a_lobe_that_cannot_be_expanded_is_refused() -> None:
    knots = (0.0, 1.0, np.pi)
    for value in (np.nan, np.inf, 0.0):
        with pytest.raises(RangeError, match="NaN, infinite or 0 throughout"):
            expand(ZonalLobe(lambda angle, value=value: np.full_like(angle, value), knots))
    with pytest.raises(RangeError, match=rf"needs more than {MAX_DEGREE} degrees .* 1e-06: make it wider"):
        expand(ggx_lobe(0.001))
    with pytest.raises(RangeError, match=r"57\.3 degrees wide needs more than"):
        expand(ZonalLobe(lambda angle: np.where(angle < 0.5, 1.0, 0.0), (0.0, 0.5, np.pi)))
    for tolerance in (0.0, 1e-13, 0.2, np.nan):
        with pytest.raises(RangeError, match=r"choose one from 1e-12 to 0\.1"):
            expand(cosine_lobe(), tolerance)


def test_parameters_out_of_range_are_refused() -> None:
    for alpha in (0.0, -0.1, 1.1, np.nan):
        for lobe in (ggx_lobe, ggx_n_dot_l_lobe):
            with pytest.raises(RangeError, match=r"alpha = .* is out of range"):
                lobe(alpha)
    for kappa in (0.0, -1.0, np.inf, np.nan):
        with pytest.raises(RangeError, match="choose one above 0"):
            von_mises_fisher_lobe(kappa)


def test_knots_ascend_from_axis_to_antipode() -> None:
    for width in (1e-4, 0.3, 2.3, 2.4, 10.0):
        knots = np.array(graded_knots(width))
        assert knots[0] == 0.0
        assert knots[-1] == np.pi
        # No panel is a sliver: the last is at least a quarter of pi.
        assert np.diff(knots).min() >= min(width, 0.25 * np.pi)
