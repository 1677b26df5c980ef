"""The fits of Kautz & McCool: profiles, energy, the paper's error curve, clustering, and its extensions."""

from collections.abc import Callable

import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf.albedo import directional_albedo
from rsibr.rsibr_addon.core.brdf.fresnel import Schlick
from rsibr.rsibr_addon.core.brdf.ggx import Ggx
from rsibr.rsibr_addon.core.brdf.lambert import Lambert
from rsibr.rsibr_addon.core.brdf.layered import Sum
from rsibr.rsibr_addon.core.brdf.metals import METALS
from rsibr.rsibr_addon.core.brdf.retroreflective import Retroreflective
from rsibr.rsibr_addon.core.brdf.ward import Ward
from rsibr.rsibr_addon.core.lobes.accuracy import fit_errors
from rsibr.rsibr_addon.core.lobes.bank import octaves
from rsibr.rsibr_addon.core.lobes.clustering import clustered
from rsibr.rsibr_addon.core.lobes.fit import Fit, lobe_axes, offsets_from_axes
from rsibr.rsibr_addon.core.lobes.kautz_mccool import (
    PLANES,
    Remainder,
    graded_angles,
    greedy_errors,
    greedy_fit,
    single_2d_fit,
    single_fit,
    with_outer_cosine,
    without_cosine,
)
from rsibr.rsibr_addon.core.lobes.radial_profile import RadialProfile, around
from rsibr.rsibr_addon.core.lobes.seeking import best_place, search

WARD = Ward(alpha=0.04, ks=0.8)
COPPER = Ggx(alpha=0.3, fresnel=METALS["copper"])
MU = np.array([0.3, 0.6, 0.9])
NORMAL = np.array([0.0, 0.0, 1.0])


def test_offsets_and_axes_are_inverse() -> None:
    rng = np.random.default_rng(2)
    offsets = rng.uniform(-1.5, 1.5, (50, 2))
    mirror = np.array([0.6, 0.0, 0.8])
    axes = lobe_axes(NORMAL, mirror, offsets)
    np.testing.assert_allclose(offsets_from_axes(NORMAL, mirror, axes), offsets, rtol=1e-9)


def test_planes_go_through_the_axis_evenly() -> None:
    axis = np.array([0.48, 0.6, 0.64])
    angles = np.array([0.0, 0.4, 2.0])
    directions = around(axis, angles, 4)
    assert directions.shape == (3, 8, 3)
    np.testing.assert_allclose(directions @ axis, np.cos(angles)[:, None] * np.ones(8), atol=1e-15)
    # Opposite halves of a plane add up to a vector along the axis
    np.testing.assert_allclose(
        directions[1, :4] + directions[1, 4:], np.tile(2 * np.cos(0.4) * axis, (4, 1)), atol=1e-15
    )


def test_profiles_become_kernels_with_the_same_integral() -> None:
    angles = graded_angles(1e-3)
    bank = octaves(4000.0)
    values = bank.values(np.sin(0.5 * angles) ** 2)[:, [3, 7, 11]]
    profile = RadialProfile(NORMAL, angles, values)
    np.testing.assert_allclose(profile.integral, 1.0, rtol=2e-3)  # the trapezoidal rule on 200 rings
    weights = profile.weights(bank)
    np.testing.assert_allclose(weights.sum(axis=0), profile.integral, rtol=1e-10)
    back = bank.values(np.sin(0.5 * angles) ** 2) @ weights
    assert np.all(np.abs(back - values).max(axis=0) < 3e-3 * values.max(axis=0))


def test_kernels_within_the_innermost_ring_have_no_weight() -> None:
    # A coat that shines at grazing alone: its kernels end within the rings about a broad lobe near the normal
    coat, base = Ggx(alpha=0.01, fresnel=Schlick(f0=0.0)), Ggx(alpha=0.4, fresnel=Schlick(f0=0.5))
    paint = Sum(parts=(coat, base))
    for fit in (single_fit(paint, "", MU), greedy_fit(paint, "", MU, 1)):
        assert fit_errors(fit, paint).error < 0.5  # no lobe at all has 1


def test_one_profile_for_all_is_the_mean_of_least_error() -> None:
    coat, base = Ggx(alpha=0.05, fresnel=Schlick(f0=0.01)), Ggx(alpha=0.4, fresnel=METALS["copper"])
    paint = Sum(parts=(coat, base))
    fit = single_2d_fit(paint, "", MU)
    each = single_fit(paint, "", MU)
    power = each.bank.products(np.zeros(()))[0]

    def error(weights: np.ndarray) -> float:
        """Squared error against the lobes of each elevation, over their power."""
        missed = weights * fit.scale[0, :, None] - each.weights[0]
        of_each = [np.einsum("skc,km,smc->s", lobe, power, lobe) for lobe in (missed, each.weights[0])]
        return float(np.sum(of_each[0] / of_each[1]))

    best = fit.weights[0, 0]
    for own in each.weights[0] / each.albedo[0][:, None]:
        assert error(best) < error(best + 0.01 * (own - best))
        assert error(best) < error(best - 0.01 * (own - best))


def test_a_single_lobe_has_the_models_energy() -> None:
    fit = single_fit(COPPER, "copper", MU)
    np.testing.assert_allclose(fit.albedo[0], directional_albedo(COPPER, MU), rtol=1e-3)
    assert not np.any(fit.offsets[..., 1])
    assert fit_errors(fit, COPPER).error < 0.45


def test_a_single_2d_lobe_needs_one_map() -> None:
    fit = single_2d_fit(WARD, "ward", MU)
    assert fit.weights.shape[:2] == (1, 1)
    np.testing.assert_allclose(fit.weights.sum(axis=2), 1.0, rtol=1e-9)  # the scale is the albedo
    np.testing.assert_allclose(fit.scale[0], directional_albedo(WARD, MU), rtol=1e-3)
    each = fit_errors(single_fit(WARD, "ward", MU), WARD).error
    assert each < fit_errors(fit, WARD).error < 2.0 * each


def test_minimum_profiles_leave_nothing_negative_on_their_planes() -> None:
    rest = Remainder(COPPER, 0.4, graded_angles(0.01))
    for _ in range(3):
        axis = rest.peak()
        lobe = rest.minimum_profile(axis)
        assert lobe.values.min() >= 0.0
        before = rest.at(around(axis, lobe.angles, PLANES))
        rest.subtract(lobe)
        after = rest.at(around(axis, lobe.angles, PLANES))
        # But for where something negative was before, between the planes of lobes elsewhere
        assert np.all(after >= np.minimum(before, 0.0) - 1e-9)
    np.testing.assert_allclose(rest.values, rest.at(rest.nodes), atol=1e-9)


def test_without_a_lobe_all_is_left() -> None:
    assert Remainder(COPPER, 0.4, graded_angles(0.01)).error() == pytest.approx(1.0)


@pytest.mark.slow
def test_the_papers_error_rises_after_six_to_nine_lobes_unless_it_is_clamped() -> None:
    # Samples every 1.5 degrees on eight planes; elevations up to 73 degrees from the normal
    mu = (np.arange(4, 16) + 0.5) / 16.0
    angles = np.linspace(0.0, np.pi, 121)
    clamped = greedy_errors(WARD, mu, 14, angles, clamped=True)
    assert np.all(np.diff(clamped) <= 0.0)
    assert clamped[13] < 0.2 * clamped[0]
    unclamped = greedy_errors(WARD, mu, 14, angles, clamped=False)
    assert 6 <= 1 + int(np.argmin(unclamped)) <= 9
    assert unclamped[13] > 1.05 * unclamped.min()


def test_clusters_are_sequences() -> None:
    rng = np.random.default_rng(8)
    paths = np.stack(
        [np.linspace([-0.3, 0.0], [-0.6, 0.1], 9), np.linspace([0.1, 0.2], [0.4, 0.0], 9)], axis=1
    )
    paths = np.concatenate([paths, np.tile([0.0, -0.4], (9, 1, 1))], axis=1)
    shuffled = np.stack([path[rng.permutation(3)] for path in paths])
    order = clustered(shuffled)
    sequences = shuffled[np.arange(9)[:, None], order]
    for sequence in sequences.swapaxes(0, 1):
        assert np.linalg.norm(np.diff(sequence, axis=0), axis=1).max() < 0.06


@pytest.mark.parametrize("seek", [best_place, search])
def test_a_lobe_at_the_view_is_found_although_its_peak_is_elsewhere(seek: object) -> None:
    # Times n.l the peak of a broad lobe at the view lies towards the normal
    model = Retroreflective(n=20.0, ks=0.5)
    rest = Remainder(model, 0.6, graded_angles(0.01))
    axis = seek(rest)  # type: ignore[operator]
    view = np.array([-0.8, 0.0, 0.6])
    peak = rest.peak()
    assert rest.minimum_profile(axis).integral.sum() >= rest.minimum_profile(peak).integral.sum()
    assert np.arccos(axis @ view) < 0.35


@pytest.mark.slow
def test_searching_beats_peaks_on_copper() -> None:
    mu = np.array([0.2, 0.5])
    by_peaks = fit_errors(greedy_fit(COPPER, "copper", mu, 2), COPPER)
    by_search = fit_errors(greedy_fit(COPPER, "copper", mu, 2, search), COPPER)
    assert by_search.error < 0.8 * by_peaks.error
    # Minimum profiles stay within the model, so that energy is lost and never gained
    assert by_search.albedo.max() < 1e-2


@pytest.mark.parametrize("fit", [single_fit, single_2d_fit])
def test_with_the_cosine_outside_uniform_light_counts_as_equation_2_says(fit: Callable[..., Fit]) -> None:
    # n.v times the integral of kd / pi over the hemisphere, where the cosine inside gives kd
    outside = with_outer_cosine(fit(without_cosine(Lambert(kd=0.4)), "lambert:kd=0.4", MU))
    np.testing.assert_allclose(outside.albedo[0], 0.8 * np.tile(MU[:, None], 3), rtol=1e-3)


def test_a_cosine_that_hardly_changes_may_be_outside() -> None:
    # Within a lobe of a hundredth, seen from near the normal, n.l is n.r
    sharp = Ward(alpha=0.01, ks=0.8)
    inside = single_fit(sharp, "", np.array([0.9]))
    outside = with_outer_cosine(single_fit(without_cosine(sharp), "", np.array([0.9])))
    np.testing.assert_allclose(outside.albedo, inside.albedo, rtol=0.01)
