"""Fits of layered models: lobes go where the error is, until an error or a number is reached."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf.albedo import directional_albedo
from rsibr.rsibr_addon.core.brdf.fresnel import Schlick
from rsibr.rsibr_addon.core.brdf.ggx import Ggx
from rsibr.rsibr_addon.core.brdf.lambert import Lambert
from rsibr.rsibr_addon.core.brdf.layered import Sum
from rsibr.rsibr_addon.core.brdf.model import Brdf, Geometry
from rsibr.rsibr_addon.core.brdf.ward import Ward
from rsibr.rsibr_addon.core.lobes import layers
from rsibr.rsibr_addon.core.lobes.accuracy import fit_errors
from rsibr.rsibr_addon.core.lobes.fit import Fit
from rsibr.rsibr_addon.core.lobes.layers import CLOSE, TAPS, layered_fit
from rsibr.rsibr_addon.core.lobes.smoothing import lines
from rsibr.rsibr_addon.core.lobes.target import elevation_slices
from rsibr.rsibr_addon.core.progress import drain

MU = np.array([0.2, 0.5, 0.8])
MANY = elevation_slices(8) + 1e-3
MODEL = Sum(parts=(Ward(alpha=0.2, ks=0.4), Lambert(kd=(0.02, 0.1, 0.3))))


@pytest.mark.slow
def test_each_layer_gets_lobes_of_its_own() -> None:
    fit = drain(layered_fit(MODEL, MU, lobes=2))
    assert fit.brdf == "sum:parts=(ward:alpha=0.2,ks=0.4)+(lambert:kd=0.02/0.1/0.3)"
    errors = fit_errors(fit, MODEL)
    assert errors.error < 0.15
    assert errors.albedo_error < 1e-3
    np.testing.assert_allclose(fit.albedo.sum(axis=0), directional_albedo(MODEL, MU), rtol=1e-3)


@pytest.mark.slow
def test_lobes_are_added_until_the_error_is_small_enough() -> None:
    coarse = drain(layered_fit(MODEL, MU, lobes=4, error=0.3))
    fine = drain(layered_fit(MODEL, MU, lobes=4, error=0.05))
    assert len(coarse.weights) < len(fine.weights) <= 8
    assert fit_errors(coarse, MODEL).error <= 0.3
    assert fit_errors(fine, MODEL).error <= 0.05


@pytest.mark.slow
def test_lobes_that_are_far_off_are_looked_up_more_often() -> None:
    coat, matt = Ggx(alpha=0.1, fresnel=Schlick(f0=0.04)), Lambert(kd=0.5)
    one, several, enough = (
        drain(layered_fit(brdf, MANY, 2, taps=taps)) for brdf, taps in ((coat, 1), (coat, None), (matt, None))
    )
    assert several.taps.shape[2] == TAPS
    assert fit_errors(one, coat).error > CLOSE
    # For no more maps
    assert several.weights.shape == one.weights.shape
    assert fit_errors(several, coat).error < 0.75 * fit_errors(one, coat).error
    assert fit_errors(enough, matt).error < CLOSE
    assert enough.taps.shape[2] == 1


class Noisy(Brdf):
    """A coat whose lobe is of another width at each elevation that it is asked for: by half, up or down."""

    coat = Ggx(alpha=0.1, fresnel=Schlick(f0=0.04))
    widths = 0.1 * (1.0 + 0.6 * np.random.default_rng(2).uniform(-1.0, 1.0, 64))

    def __init__(self, is_told: bool = False) -> None:
        self.is_told = is_told

    @property
    def is_noisy(self) -> bool:
        return self.is_told

    def above_horizon(self, geometry: Geometry) -> np.ndarray:
        cell = int(32.0 * geometry.n_dot_v[0])
        return Ggx(alpha=self.widths[cell], fresnel=self.coat.fresnel).above_horizon(geometry)


@pytest.mark.slow
def test_taps_that_follow_noise_are_not_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(layers, "spec_from_brdf", lambda brdf: "noisy")
    noisy, clean = (drain(layered_fit(brdf, MANY, 2)) for brdf in (Noisy(), Noisy.coat))
    assert clean.taps.shape[2] == TAPS
    assert noisy.taps.shape[2] == 1


@pytest.mark.slow
def test_layers_that_hardly_count_keep_one_tap() -> None:
    model = Sum(parts=(Ward(alpha=0.05, ks=0.8), Lambert(kd=0.01)))
    fit = drain(layered_fit(model, MANY, lobes=2))
    assert fit.taps.shape[2] == TAPS
    used = np.count_nonzero(np.any(fit.taps, axis=1), axis=1)
    assert used.tolist() == [TAPS, TAPS, 1]


@pytest.mark.slow
def test_smoothing_brings_a_noisy_fit_nearer_to_the_truth(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(layers, "spec_from_brdf", lambda brdf: "noisy")
    rough, smooth = (drain(layered_fit(Noisy(told), MANY, 2, taps=1)) for told in (False, True))
    rough_error, error = (fit_errors(fit, Noisy.coat).error for fit in (rough, smooth))
    assert error < 0.9 * rough_error

    def bent(fit: Fit) -> float:
        return float(np.abs(lines(fit.mu) @ fit.offsets[..., 0, 0].T).mean())

    assert bent(smooth) < 0.5 * bent(rough)


def test_what_lies_on_lines_costs_nothing() -> None:
    mu = np.array([0.05, 0.2, 0.5, 0.55, 1.0])
    np.testing.assert_allclose(lines(mu) @ np.stack([mu, 3.0 - 2.0 * mu], axis=1), 0.0, atol=1e-15)
    # And of a parabola, how far its chord is: share (1 - share) (above - below)^2
    np.testing.assert_allclose(lines(mu) @ mu**2, -(mu[1:-1] - mu[:-2]) * (mu[2:] - mu[1:-1]))
    assert lines(mu[:2]).shape == (0, 2)
