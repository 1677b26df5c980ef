"""The quadrature over the hemisphere, and the warning that rests on it."""

import math
import warnings

import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf.albedo import directional_albedo, hemisphere_quadrature, warn_of_gain
from rsibr.rsibr_addon.core.brdf.lambert import Lambert
from rsibr.rsibr_addon.core.brdf.phong import Phong
from rsibr.rsibr_addon.core.errors import RangeError, RsibrWarning

ELEVATIONS = [1.0, 0.999, 0.9, 0.7071, 0.5, 0.2, 0.03, 0.001]


@pytest.mark.parametrize("mu", ELEVATIONS)
def test_polynomials_are_integrated_over_the_hemisphere(mu: float) -> None:
    light_dir, weight = hemisphere_quadrature(mu)
    x, y, z = light_dir.T
    np.testing.assert_allclose(x**2 + y**2 + z**2, 1.0, rtol=1e-12)
    assert z.min() > 0.0
    assert weight.min() > 0.0
    # Moments of the half sphere. Arcs that touch the horizon or the border at a narrow angle end in kinks
    # of which the panels leave 1e-6
    for values, expected in ((1.0, 2 * np.pi), (z, np.pi), (x, 0.0), (y, 0.0), (x * y, 0.0)):
        assert np.sum(weight * values) == pytest.approx(expected, abs=1e-6)
    for values in (x**2, y**2, z**2):
        assert np.sum(weight * values) == pytest.approx(2 * np.pi / 3, abs=1e-6)


@pytest.mark.parametrize("mu", ELEVATIONS)
@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_thin_lobes_at_the_mirror_and_the_view_are_caught(mu: float, side: float) -> None:
    # A von Mises-Fisher lobe of 0.02 radians: its integral over the whole sphere is 1
    axis = np.array([side * np.sqrt(1.0 - mu**2), 0.0, mu])
    width = 0.02
    light_dir, weight = hemisphere_quadrature(mu)
    squared = np.sum((light_dir - axis) ** 2, axis=1)
    total = np.sum(weight * np.exp(-squared / (2.0 * width**2))) / (2.0 * np.pi * width**2)
    # Above the horizon lies a share of it: all, or the half plane's share of a Gaussian near grazing
    height = np.arcsin(mu) / width
    share = 0.5 * (1.0 + math.erf(height / math.sqrt(2.0)))
    assert total == pytest.approx(share, abs=2e-4)  # the Gaussian is flat, the sphere is not: width^2 / 2


@pytest.mark.parametrize("mu", [0.0, -0.5, 1.1, float("nan")])
def test_elevations_below_the_horizon_are_refused(mu: float) -> None:
    with pytest.raises(RangeError, match="greater than 0 and at most 1"):
        hemisphere_quadrature(mu)


def test_shapes_follow_the_elevations() -> None:
    brdf = Lambert(kd=(0.2, 0.4, 0.6))
    albedo = directional_albedo(brdf, [[1.0, 0.5], [0.2, 0.1]])
    assert albedo.shape == (2, 2, 3)
    np.testing.assert_allclose(albedo, np.broadcast_to((0.2, 0.4, 0.6), (2, 2, 3)), rtol=1e-6)
    assert directional_albedo(brdf, 0.5).shape == (3,)


def test_a_function_will_do_for_a_model() -> None:
    def half(light_dir: np.ndarray, view_dir: np.ndarray) -> np.ndarray:
        return np.full((len(light_dir), 3), 0.5 / np.pi)

    np.testing.assert_allclose(directional_albedo(half, 0.3), 0.5, rtol=1e-6)


def test_gain_is_told_and_losses_are_not() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warn_of_gain(Lambert(kd=1.0), "white")
        warn_of_gain(Phong(n=10.0, ks=0.5, kd=0.5), "half and half")
    with pytest.warns(
        RsibrWarning, match=r"too much reflects 1\.9.* times the light it receives at 14 degrees"
    ):
        warn_of_gain(Phong(n=10.0, ks=1.0, kd=1.0), "too much")
