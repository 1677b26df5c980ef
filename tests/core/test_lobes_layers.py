"""Fits of layered models: lobes go where the error is, until an error or a number is reached."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf.albedo import directional_albedo
from rsibr.rsibr_addon.core.brdf.lambert import Lambert
from rsibr.rsibr_addon.core.brdf.layered import Sum
from rsibr.rsibr_addon.core.brdf.ward import Ward
from rsibr.rsibr_addon.core.lobes.accuracy import fit_errors
from rsibr.rsibr_addon.core.lobes.layers import layered_fit
from rsibr.rsibr_addon.core.progress import drain

MU = np.array([0.2, 0.5, 0.8])
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
