"""Families of lobes: Fresnel terms as powers, interpolation, tilts that are smoothed."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf.fresnel import fresnel_conductor, fresnel_schlick
from rsibr.rsibr_addon.core.brdf.fresnel_powers import dielectric, powers_of, rise, schlick
from rsibr.rsibr_addon.core.errors import RangeError, ShapeError
from rsibr.rsibr_addon.core.lobes.bank import octaves
from rsibr.rsibr_addon.core.lobes.family import Family
from rsibr.rsibr_addon.core.lobes.family_fit import smoothed

COSINE = np.linspace(0.0, 1.0, 101)


def small_family(rng: np.random.Generator) -> Family:
    bank = octaves(4.0)
    return Family(
        np.array([0.1, 0.2, 0.4]),
        np.array([0.25, 0.75]),
        bank,
        rng.normal(size=(3, 2, 2)),
        rng.normal(size=(3, 2, 2, len(bank), 5)),
    )


def test_schlick_s_term_is_a_sum_of_powers() -> None:
    np.testing.assert_allclose(powers_of(COSINE) @ schlick(0.3), fresnel_schlick(COSINE, 0.3), rtol=1e-14)


def test_a_tinted_edge_is_a_sum_of_powers() -> None:
    expected = fresnel_schlick(COSINE, 0.3) - 0.7 * COSINE * (1.0 - COSINE) ** 6
    np.testing.assert_allclose(powers_of(COSINE) @ schlick(0.3, 0.7), expected, rtol=1e-14, atol=1e-15)


@pytest.mark.parametrize("index", [1.33, 1.5, 2.0, 2.5])
def test_a_dielectric_s_term_is_a_sum_of_powers_nearly(index: float) -> None:
    exact = fresnel_conductor(COSINE, index, 0.0)
    relative = (powers_of(COSINE) @ dielectric(index)) / exact - 1.0
    # Over a sphere's picture cosines count by themselves
    assert np.sqrt(np.average(relative**2, weights=COSINE)) < 0.0025
    assert rise((index - 1.0) / (index + 1.0))[0] == 0.0


def test_samples_are_met_and_between_them_all_is_linear() -> None:
    rng = np.random.default_rng(1)
    family = small_family(rng)
    np.testing.assert_allclose(family.at(family.tilts, family.alpha[:, None], family.mu), family.tilts)
    halfway = family.at(family.weights, np.sqrt(0.1 * 0.2), 0.5)
    np.testing.assert_allclose(halfway, family.weights[:2].mean(axis=(0, 1)))
    beyond = family.at(family.weights, 0.0, 1.0)
    np.testing.assert_allclose(beyond, family.weights[0, 1])


def test_at_other_elevations_a_family_is_what_it_was_between_its_own() -> None:
    family = small_family(np.random.default_rng(1))
    middle = family.at_elevations(np.array([0.5]))
    np.testing.assert_allclose(middle.tilts[:, 0], family.tilts.mean(axis=1))
    np.testing.assert_allclose(middle.weights[:, 0], family.weights.mean(axis=1))


def test_a_material_s_fit_evaluates_to_its_functions() -> None:
    rng = np.random.default_rng(1)
    family = small_family(rng)
    coefficients = rng.normal(size=(5, 3))
    fit = family.fit(0.2, coefficients, "any")
    np.testing.assert_allclose(fit.albedo.sum(axis=0), family.albedo[1] @ coefficients)
    np.testing.assert_array_equal(fit.offsets[..., 0, 0].T, family.tilts[1])


def test_smoothing_keeps_planes_and_flattens_noise() -> None:
    rng = np.random.default_rng(1)
    rows, columns = np.sort(rng.random(6)), np.sort(rng.random(5))
    plane = (rows[:, None] + 2.0 * columns)[..., None]
    np.testing.assert_allclose(smoothed(plane, rows, columns, 1e3), plane, rtol=1e-9)
    noise = rng.normal(size=plane.shape)
    assert np.sum(smoothed(noise, rows, columns, 1.0) ** 2) < np.sum(noise**2)


def test_a_family_that_cannot_be_is_refused() -> None:
    rng = np.random.default_rng(1)
    family = small_family(rng)
    parts = family.alpha, family.mu, family.bank, family.tilts, family.weights
    with pytest.raises(ShapeError, match="do not belong to 3 widths and 2 elevations"):
        Family(*parts[:3], family.tilts[..., :1], family.weights)
    with pytest.raises(RangeError, match="alpha of a family does not ascend"):
        Family(family.alpha[::-1], *parts[1:])
    with pytest.raises(RangeError, match="not finite"):
        Family(*parts[:3], family.tilts * np.nan, family.weights)
