"""The joint fit: derivatives, exact recovery, the errors that it reaches, what it promises."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf.fresnel import Schlick
from rsibr.rsibr_addon.core.brdf.ggx import Ggx
from rsibr.rsibr_addon.core.brdf.lambert import Lambert
from rsibr.rsibr_addon.core.brdf.layered import Sum
from rsibr.rsibr_addon.core.brdf.metals import METALS
from rsibr.rsibr_addon.core.brdf.ward import Ward
from rsibr.rsibr_addon.core.errors import RangeError
from rsibr.rsibr_addon.core.lobes import joint
from rsibr.rsibr_addon.core.lobes.accuracy import fit_errors
from rsibr.rsibr_addon.core.lobes.bank import SHARP, SHARPEST, octaves
from rsibr.rsibr_addon.core.lobes.fit import Fit, lobe_axes
from rsibr.rsibr_addon.core.lobes.joint import JointFitter, bank_for
from rsibr.rsibr_addon.core.lobes.nonnegative import nonnegative_inverse
from rsibr.rsibr_addon.core.lobes.projection import Lookups, Projector
from rsibr.rsibr_addon.core.lobes.target import elevation_slices, target_slices

COPPER = Ggx(alpha=0.3, fresnel=METALS["copper"])
WARD = Ward(alpha=0.04, ks=0.8)


def fitted(brdf: object, lobes: int, mu: np.ndarray, taps: int = 1, non_negative: bool = False) -> Fit:
    fitter = JointFitter(target_slices(brdf, mu), "model", non_negative)
    for _ in range(lobes):
        fitter.grow()
    return fitter.fit(taps)[0]


class TwoLobes:
    """Radial lobes about two axes over n.l, so narrow that at mu > 0.6 nothing is below the horizon."""

    bank = octaves(400.0)
    offsets = np.array([[0.1, 0.0], [-0.15, 0.0]])
    weights = np.array([[0.3, 0.2, 0.1], [0.1, 0.2, 0.4]])

    def __call__(self, light_dir: np.ndarray, view_dir: np.ndarray) -> np.ndarray:
        mirror = view_dir * (-1.0, -1.0, 1.0)
        axes = lobe_axes(np.array([0.0, 0.0, 1.0]), mirror, self.offsets)
        lobe = np.zeros(light_dir.shape)
        for axis, weight, kernel in zip(axes, self.weights, (9, 10), strict=True):
            values = self.bank.values(0.25 * np.sum((light_dir - axis) ** 2, axis=-1))[:, kernel]
            lobe += values[:, None] * weight
        return lobe / light_dir[:, 2:]


def test_a_fit_knows_its_own_error() -> None:
    fitter = JointFitter(target_slices(COPPER, elevation_slices(5)), "model")
    fitter.grow()
    fitter.grow()
    fit, errors = fitter.fit()
    measured = fit_errors(fit, COPPER).shape
    # Ridges add 5e-5 of each lobe's power, that of the model or a few times it; to errors of .1, 1e-3
    np.testing.assert_allclose(errors, measured, atol=2e-3)
    assert np.all(errors > measured - 1e-4)


def test_gradient_is_the_slope_of_the_objective() -> None:
    (target,) = target_slices(COPPER, [0.35])
    projector = Projector(target, octaves(256.0))
    angles, taps = target.theta + np.array([[-0.05, 0.03], [0.1, 0.2]]), np.array([[1.0, 0.6], [0.7, 0.4]])
    place = np.concatenate([angles.ravel(), taps.ravel()])

    def objective(place: np.ndarray) -> float:
        return projector.objective(Lookups(place[:4].reshape(2, 2), place[4:].reshape(2, 2)))

    projection = projector.project(Lookups(angles, taps))
    assert projection.objective == objective(place)
    step = 1e-5 * np.eye(8)
    slope = [(objective(place + move) - objective(place - move)) / 2e-5 for move in step]
    # The objective is good to about 1e-12, the difference over 2e-5 to 1e-7
    np.testing.assert_allclose(projection.gradient, slope, atol=2e-6 * np.abs(slope).max())


def test_a_sum_of_lobes_is_found_again() -> None:
    mu = np.array([0.65, 0.75, 0.85, 0.95])
    model = TwoLobes()
    fit = fitted(model, 2, mu)
    # What is left is what the ridges cost: about the root of 5e-5 of what they touch
    assert fit_errors(fit, model).error < 5e-3
    order = np.argsort(-fit.offsets[:, 0, 0, 0])
    np.testing.assert_allclose(
        fit.offsets[order, :, 0, 0], np.repeat(model.offsets[:, :1], 4, axis=1), atol=5e-3
    )
    # Both have wide skirts, which may be counted to either
    np.testing.assert_allclose(fit.albedo[order, 1], model.weights, atol=0.03)
    np.testing.assert_allclose(fit.albedo[:, 1].sum(axis=0), model.weights.sum(axis=0), rtol=1e-4)


@pytest.mark.slow
def test_copper_and_ward_reach_their_errors() -> None:
    mu = elevation_slices(16)
    for brdf, expected in ((COPPER, (0.33, 0.15, 0.076)), (WARD, (0.45, 0.33, 0.24))):
        errors = [fit_errors(fitted(brdf, lobes, mu), brdf) for lobes in (1, 2, 3)]
        for error, limit in zip(errors, expected, strict=True):
            assert error.error < limit
            assert error.albedo_error < 1e-4
            assert np.all(error.amplification <= 8.001)
        assert errors[0].error > errors[1].error > errors[2].error
        between = fit_errors(fitted(brdf, 3, mu), brdf, np.arange(1, 16) / 16.0).shape
        assert np.all(between <= 0.5 * (errors[2].shape[1:] + errors[2].shape[:-1]) + 0.005)


@pytest.mark.slow
def test_one_map_with_five_taps_does_what_four_lobes_do() -> None:
    fit = fitted(WARD, 1, elevation_slices(16), taps=5)
    errors = fit_errors(fit, WARD)
    assert fit.weights.shape[0] == 1
    assert errors.error < 0.19
    assert np.all(errors.amplification <= 2.001)
    np.testing.assert_allclose(np.abs(fit.taps).sum(axis=2), 1.0, rtol=1e-12)
    # Between two elevations the fit is as good as between them on average, and a little
    between = fit_errors(fit, WARD, np.arange(1, 16) / 16.0).shape
    mean = 0.5 * (errors.shape[1:] + errors.shape[:-1])
    assert np.all(between <= mean + 0.01)


def test_kernels_stay_positive_on_request() -> None:
    mu = np.array([0.2, 0.7])
    fit = fitted(COPPER, 2, mu, non_negative=True)
    assert fit.weights.min() >= 0.0
    signed = fit_errors(fitted(COPPER, 2, mu), COPPER).error
    assert signed < fit_errors(fit, COPPER).error < 1.5 * signed


def test_lambert_is_a_lobe_about_the_normal() -> None:
    mu = np.array([0.3, 0.6, 0.9])
    fit = fitted(Lambert(kd=(0.2, 0.4, 0.6)), 1, mu)
    for index, cosine in enumerate(mu):
        mirror = np.array([np.sqrt(1.0 - cosine**2), 0.0, cosine])
        axis = lobe_axes(np.array([0.0, 0.0, 1.0]), mirror, fit.offsets[0, index, 0])
        assert axis[2] == pytest.approx(1.0, abs=1e-4)
    np.testing.assert_allclose(fit.albedo[0], np.tile((0.2, 0.4, 0.6), (3, 1)), rtol=1e-4)


def test_an_exact_fit_has_no_error_though_rounding_makes_it_negative(monkeypatch: pytest.MonkeyPatch) -> None:
    descend = joint.descend

    def rounded(*asked: Any) -> Any:
        lookups, projection = descend(*asked)
        return lookups, replace(projection, objective=-1e-17)

    monkeypatch.setattr(joint, "descend", rounded)
    (target,) = target_slices(Lambert(kd=0.5), [0.7])
    start = Lookups(np.array([[0.1]]), np.ones((1, 1)))
    assert joint.settled(target, octaves(SHARP), start, non_negative=False).error == 0.0


def test_nonnegative_least_squares_fulfil_their_conditions() -> None:
    rng = np.random.default_rng(3)
    columns = rng.normal(size=(30, 12))
    system, right = columns.T @ columns, columns.T @ rng.normal(size=30)
    x = nonnegative_inverse(system, right) @ right
    slope = system @ x - right
    # Karush-Kuhn-Tucker: x >= 0, slope >= 0, and one of both 0
    assert x.min() >= 0.0
    assert slope.min() > -1e-9
    assert np.abs(x * slope).max() < 1e-9
    assert 0 < np.count_nonzero(x) < 12


def test_nonnegative_least_squares_end_where_rounding_leaves_a_little() -> None:
    # A step to 0 left the third unknown at 5e-324, whence no further step led
    upper = [
        [1.0000000009999992, 0.6630288621058767, 0.3162171786022396],
        [0.9997975060909123, 0.6640075359090708, 0.31906950221486785],
        [1.000000000999999, 0.8024702130671859, 0.6643202295430993, 0.9999101003489832, 0.8060070777813622],
        [1.000000001, 0.31767521258224996, 0.8010919656746973, 0.999948638971967],
        [1.000000001, 0.6654601574879785, 0.3205676393921582],
        [1.000000001000001, 0.8047196642561221],
        [1.0000000010000007],
    ]
    system = np.zeros((6, 6))
    system[np.triu_indices(6)] = np.concatenate(upper)
    system += np.triu(system, 1).T
    right = np.array(
        [15.662995139463563, 15.402803311126068, 12.561901872296731]
        + [15.672990625615851, 15.40455550398731, 12.599614981322896]
    )
    x = nonnegative_inverse(system, right) @ right
    assert np.flatnonzero(x).tolist() == [0, 5]
    assert x.min() >= 0.0
    assert (system @ x - right).min() > -1e-9


@pytest.mark.parametrize("count", [0, 257])
def test_too_few_and_too_many_elevations_are_refused(count: int) -> None:
    with pytest.raises(RangeError, match="choose 1 to 256"):
        elevation_slices(count)


def test_a_black_model_is_refused() -> None:
    with pytest.raises(RangeError, match="black, NaN or infinite at 60 degrees"):
        target_slices(Lambert(kd=0.0), [0.5])


def test_a_thin_peak_on_a_broad_base_has_kernels_of_its_own() -> None:
    peak, base = Ggx(alpha=0.01, fresnel=Schlick(f0=0.04)), Lambert(kd=0.5)
    slices = target_slices(Sum(parts=(peak, base)), [0.2, 0.5, 0.8])
    assert bank_for(slices).concentrations[-1] == SHARPEST
    # As round lobes have half of their power within a core of that concentration
    assert min(target.core for target in slices) ** -2 > SHARP / 4.0
    assert bank_for(target_slices(base, [0.2, 0.5, 0.8])).concentrations[-1] < 1e3


def test_smoothing_keeps_the_greatest_amplification(monkeypatch: pytest.MonkeyPatch) -> None:
    coat = Ggx(alpha=0.3, fresnel=Schlick(f0=0.04))
    fitter = JointFitter(target_slices(coat, elevation_slices(6)), "coat")
    for _ in range(3):
        fitter.grow()
    fit, _ = fitter.fit()
    most = fit_errors(fit, coat).amplification.max()
    assert most > 3.0
    monkeypatch.setattr(joint, "MOST_AMPLIFICATION", 3.0)
    assert fit_errors(fitter.smooth(fit, 0.3), coat).amplification.max() <= 3.0
