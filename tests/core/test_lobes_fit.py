"""Fits: where axes lie, what lies between elevations, sums of fits, and fits that cannot be."""

from dataclasses import replace

import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import RangeError, ShapeError
from rsibr.rsibr_addon.core.lobes.bank import KernelBank
from rsibr.rsibr_addon.core.lobes.fit import Fit, joined, lobe_axes

RNG = np.random.default_rng(7)
NORMAL = np.array([0.0, 0.0, 1.0])


def random_fit(kernels: tuple[float, ...] = (1.0, 8.0, 64.0), taps: int = 2, profiles: int = 4) -> Fit:
    lobes, slices = 3, 4
    return Fit(
        brdf="phong:n=9,ks=0.5",
        method="joint",
        mu=np.array([0.1, 0.3, 0.6, 0.9]),
        bank=KernelBank(kernels),
        weights=RNG.normal(size=(lobes, profiles, len(kernels), 3)),
        scale=RNG.uniform(0.5, 2.0, (lobes, slices, 3)),
        offsets=RNG.normal(scale=0.3, size=(lobes, slices, taps, 2)),
        taps=RNG.normal(size=(lobes, slices, taps)),
    )


def test_offsets_are_arcs_from_the_mirror_direction() -> None:
    theta, tilt = 0.9, 0.25
    mirror = np.array([np.sin(theta), 0.0, np.cos(theta)])
    axis = lobe_axes(NORMAL, mirror, [tilt, 0.0])
    inclined = theta - tilt * np.sin(theta)  # towards the normal
    np.testing.assert_allclose(axis, [np.sin(inclined), 0.0, np.cos(inclined)], atol=1e-15)
    aside = lobe_axes(NORMAL, mirror, [0.0, tilt])
    assert aside[1] == pytest.approx(np.sin(tilt * np.sin(theta)))
    assert aside @ mirror == pytest.approx(np.cos(tilt * np.sin(theta)))
    np.testing.assert_array_equal(lobe_axes(NORMAL, NORMAL, [1.0, -2.0]), NORMAL)


def test_offsets_turn_with_the_surface() -> None:
    # Any rotation of normal and mirror direction rotates the axis
    turn, _ = np.linalg.qr(RNG.normal(size=(3, 3)))
    turn *= np.linalg.det(turn)
    mirror = np.array([0.6, 0.0, 0.8])
    offset = np.array([0.3, -0.2])
    np.testing.assert_allclose(
        lobe_axes(turn @ NORMAL, turn @ mirror, offset), turn @ lobe_axes(NORMAL, mirror, offset), atol=1e-14
    )
    assert np.linalg.norm(lobe_axes(NORMAL, mirror, offset)) == pytest.approx(1.0, abs=1e-15)


def test_at_an_elevation_a_fit_is_what_it_holds() -> None:
    fit = random_fit()
    light_dir = np.array([0.36, 0.48, 0.8])
    mirror = np.array([np.sqrt(1.0 - 0.3**2), 0.0, 0.3])
    total = np.zeros(3)
    for lobe in range(3):
        axes = lobe_axes(NORMAL, mirror, fit.offsets[lobe, 1])
        for tap in range(2):
            angle = np.arccos(light_dir @ axes[tap])
            profile = [fit.lobe(lobe, 1, channel).profile(angle) for channel in range(3)]
            total += fit.taps[lobe, 1, tap] * fit.scale[lobe, 1] * profile
    np.testing.assert_allclose(fit.evaluate(light_dir, 0.3), total, rtol=1e-10)


def test_between_elevations_fits_are_mixed_and_beyond_they_end() -> None:
    fit = random_fit(taps=1)
    fit = replace(fit, scale=np.ones_like(fit.scale), taps=np.ones_like(fit.taps), offsets=0.0 * fit.offsets)
    axes, weights = fit.at(0.4)
    np.testing.assert_allclose(weights, fit.weights[:, 1] * 2 / 3 + fit.weights[:, 2] / 3, rtol=1e-12)
    np.testing.assert_allclose(axes, np.tile([np.sqrt(1.0 - 0.4**2), 0.0, 0.4], (3, 1)), atol=1e-15)
    np.testing.assert_array_equal(fit.at(0.01)[1], fit.weights[:, 0])
    np.testing.assert_array_equal(fit.at(1.0)[1], fit.weights[:, 3])


def test_one_profile_serves_all_elevations() -> None:
    fit = random_fit(profiles=1)
    repeated = replace(fit, weights=np.repeat(fit.weights, 4, axis=1))
    light_dir = RNG.normal(size=(5, 3))
    light_dir /= np.linalg.norm(light_dir, axis=1, keepdims=True)
    for mu in (0.05, 0.3, 0.7, 1.0):
        np.testing.assert_allclose(fit.evaluate(light_dir, mu), repeated.evaluate(light_dir, mu), rtol=1e-12)


def test_albedo_is_the_integral() -> None:
    fit = random_fit()
    _, weights = fit.at(0.6)
    np.testing.assert_allclose(fit.albedo[:, 2].sum(axis=0), weights.sum(axis=(0, 1)), rtol=1e-12)


def test_joined_fits_add_up() -> None:
    one, other = random_fit((1.0, 8.0), taps=1), random_fit((2.0, 8.0, 16.0), taps=3, profiles=1)
    both = joined([one, other], "sum")
    assert both.bank.concentrations == (1.0, 2.0, 8.0, 16.0)
    assert both.taps.shape == (6, 4, 3)
    light_dir = np.array([[0.0, 0.6, 0.8], [0.6, 0.0, -0.8]])
    for mu in (0.1, 0.45):
        np.testing.assert_allclose(
            both.evaluate(light_dir, mu),
            one.evaluate(light_dir, mu) + other.evaluate(light_dir, mu),
            atol=1e-13,
        )


@pytest.mark.parametrize("name", ["mu", "weights", "scale", "offsets", "taps"])
def test_arrays_that_do_not_fit_are_refused(name: str) -> None:
    fit = random_fit()
    with pytest.raises(ShapeError, match="unlike the rest: make it anew"):
        replace(fit, **{name: getattr(fit, name)[:-1] if name == "mu" else getattr(fit, name)[..., :-1]})
    broken = getattr(fit, name).copy()
    broken.flat[0] = np.nan
    with pytest.raises(RangeError, match=f"{name} of a fit"):
        replace(fit, **{name: broken})


@pytest.mark.parametrize("mu", [[0.0, 0.1, 0.2, 0.3], [0.2, 0.2, 0.3, 0.4], [0.1, 0.2, 0.3, 1.1]])
def test_elevations_must_ascend(mu: list[float]) -> None:
    with pytest.raises(RangeError, match="does not ascend from above 0 to at most 1"):
        replace(random_fit(), mu=np.array(mu))
