"""Sheen: its transform found again, and its lobes about the normal against the transform itself."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf import sheen_polynomials
from rsibr.rsibr_addon.core.brdf.albedo import hemisphere_quadrature
from rsibr.rsibr_addon.core.brdf.principled import Surface, layers_of
from rsibr.rsibr_addon.core.brdf.sheen import Sheen, transform_of, transformed_cosine
from rsibr.rsibr_addon.core.brdf.sheen_polynomials import fit_polynomials, sheen_at
from rsibr.rsibr_addon.core.errors import RangeError, ShapeError
from rsibr.rsibr_addon.core.lobes.rings import WIDTHS, SheenTable, ring, ring_errors, ring_weights
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.files.families import shipped_sheen
from rsibr.rsibr_addon.files.kinds.kernel_pyramid import shipped_families

MU = np.array([0.1, 0.5])


@pytest.mark.parametrize(("a", "b"), [(0.3, -0.2), (0.8, 0.0), (1.5, 0.4)])
def test_a_transformed_cosine_integrates_to_1_and_its_transform_comes_back(a: float, b: float) -> None:
    light_dir, weight = hemisphere_quadrature(0.5)
    values = transformed_cosine(*light_dir.T, a, b)
    # The quadrature is made for smooth lobes
    assert weight @ values == pytest.approx(1.0, abs=1e-3)
    some = light_dir[light_dir[:, 2] > 0.1][::200]
    reflectance = 0.7 * transformed_cosine(*some.T, a, b) / some[:, 2]
    np.testing.assert_allclose(transform_of(some, reflectance), (a, b, 0.7), rtol=1e-9, atol=1e-9)


def test_below_the_horizon_there_is_none() -> None:
    assert transformed_cosine(0.6, 0.0, -0.8, 0.5) == 0.0


@pytest.mark.parametrize("width", [1.0, *WIDTHS])
def test_a_ring_integrates_to_1(width: float) -> None:
    cosine = np.linspace(0.0, 1.0, 100001)
    assert 2.0 * np.pi * np.trapezoid(ring(cosine, width), cosine) == pytest.approx(1.0, rel=1e-5)


def test_what_is_about_the_normal_is_met_and_what_leans_costs_what_is_stated() -> None:
    a, albedo = np.array([WIDTHS[1], 1.0]), np.array([0.5, 0.2])
    upright = Sheen(MU, a, np.zeros(2), albedo)
    weights = ring_weights(upright)
    np.testing.assert_allclose(weights, [[0.0, 0.0, 0.5, 0.0], [0.2, 0.0, 0.0, 0.0]], atol=1e-6)
    leaning = Sheen(MU, a, np.array([-0.3, 0.0]), albedo)
    found = ring_weights(leaning)
    assert np.all(found >= 0.0)
    np.testing.assert_allclose(found.sum(axis=1), albedo, rtol=1e-5)
    errors = ring_errors(leaning, found)
    assert errors[0] > 0.1
    assert errors[1] < 1e-5


def test_sheen_that_polynomials_are_comes_back(monkeypatch: pytest.MonkeyPatch) -> None:
    roughnesses, mu = (0.1, 0.35, 1.0), np.linspace(0.0, 1.0, 9)
    wanted = [sheen_at(roughness, mu) for roughness in roughnesses]
    monkeypatch.setattr(sheen_polynomials, "COEFFICIENTS", drain(fit_polynomials(sheen_at)))
    for roughness, each in zip(roughnesses, wanted, strict=True):
        albedo = sheen_at(roughness, mu).albedo
        # What is next to nothing has no transform, and its albedo no logarithm
        np.testing.assert_allclose(albedo, each.albedo, atol=5e-3)
        there = each.albedo > 0.05
        for name in ("a", "b"):
            found = getattr(sheen_at(roughness, mu), name)
            np.testing.assert_allclose(found[there], getattr(each, name)[there], atol=5e-3)


def test_between_samples_a_table_is_linear() -> None:
    table = shipped_sheen()
    count, rows, _ = table.weights.shape
    roughness, mu = np.arange(count) / (count - 1), (np.arange(rows) + 0.5) / rows
    np.testing.assert_allclose(table.at(roughness[:, None], mu), table.weights, atol=1e-12)
    middle = 0.25 * sum(table.weights[20 + i, 7 + j] for i in (0, 1) for j in (0, 1))
    np.testing.assert_allclose(table.at(roughness[20:22].mean(), mu[7:9].mean()), middle, rtol=1e-12)
    np.testing.assert_array_equal(table.at(2.0, 0.0), table.weights[-1, 0])


def test_a_table_of_something_else_is_refused() -> None:
    with pytest.raises(ShapeError, match="is none of ours"):
        SheenTable(np.ones((4, 4, 2)))
    with pytest.raises(RangeError, match="negative or not finite"):
        SheenTable(np.full((4, 4, 1 + len(WIDTHS)), -1.0))


def test_sheen_takes_from_all_below_what_its_brightest_channel_reflects() -> None:
    surface = Surface(
        base_color=(0.5, 0.5, 0.5),
        coat_weight=0.5,
        emission=(1.0, 2.0, 3.0),
        sheen_weight=0.8,
        sheen_tint=(0.2, 1.0, 0.5),
    )
    families, mu = shipped_families(), np.array([0.2, 0.7])
    bare = layers_of(Surface(**{**vars(surface), "sheen_weight": 0.0}), mu, families)
    clad = layers_of(surface, mu, families)
    left = 1.0 - 0.8 * families.sheen(np.array(0.5), mu)
    for name in ("coat", "base", "diffuse", "emission"):
        below = getattr(bare, name)
        share = left.reshape(-1, *[1] * (below.ndim - 1))
        np.testing.assert_allclose(getattr(clad, name), share * below, rtol=1e-12)
    np.testing.assert_allclose(clad.sheen, [0.16, 0.8, 0.4])
    assert not np.any(bare.sheen)
