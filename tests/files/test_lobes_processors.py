"""Fits are the same on every processor."""

import json
import os
import subprocess
import sys

import numpy as np
import pytest
from rsibr.tests.files.processors import SETTINGS

FIT = """
import json, sys
import numpy as np
from rsibr.rsibr_addon.files.brdfs import brdf_from_spec
from rsibr.rsibr_addon.core.lobes.accuracy import fit_errors
from rsibr.rsibr_addon.core.lobes.joint import JointFitter
from rsibr.rsibr_addon.core.lobes.target import elevation_slices, target_slices

np.ones((800, 800)) @ np.ones((800, 800))  # crashes where OpenBLAS is broken
azimuth, height = np.meshgrid(np.linspace(0.0, np.pi, 16), np.linspace(0.03, 0.97, 16))
side = np.sqrt(1.0 - height**2)
LIGHT = np.stack([side * np.cos(azimuth), side * np.sin(azimuth), height], axis=-1)

told = []
for spec, lobes, taps in json.loads(sys.argv[1]):
    brdf = brdf_from_spec(spec)
    fitter = JointFitter(target_slices(brdf, elevation_slices(16)), spec)
    for _ in range(lobes):
        fitter.grow()
    fit, _ = fitter.fit(taps)
    told.append([fit_errors(fit, brdf).error, fit.evaluate_lobes(LIGHT, 0.4).tolist()])
print(json.dumps(told))
"""

COPPER, WARD = "ggx:alpha=0.3,metal=copper", "ward:alpha=0.04,ks=0.8"
PLASTIC = "ggx:alpha=0.1,f0=0.04"
FITS = [(COPPER, 2, 3), (WARD, 1, 5), (PLASTIC, 3, 3)]


def fitted(setting: dict[str, str]) -> list[tuple[float, np.ndarray]]:
    """E of every fit and its lobes seen from one elevation, from a process of its own."""
    free = {name: value for name, value in os.environ.items() if not name.startswith(("OPENBLAS", "NPY"))}
    command = [sys.executable, "-c", FIT, json.dumps(FITS)]
    run = subprocess.run(
        command, env={**free, **setting}, capture_output=True, text=True, check=False, timeout=300
    )
    assert run.returncode == 0, f"{setting}: {run.returncode} {run.stderr}"
    return [(error, np.array(lobes)) for error, lobes in json.loads(run.stdout)]


@pytest.mark.slow
def test_fits_are_the_same_on_every_processor() -> None:
    everywhere = [fitted(setting) for setting in SETTINGS.values()]
    for spec, *same in zip(FITS, *everywhere, strict=True):
        errors = [error for error, _ in same]
        # A descent ends where a step gains less than 1e-5 of the squared error, so half of that of the error;
        # lobes, which the error is flat in there, are good to the root of it
        assert max(errors) <= (1.0 + 1e-5) * min(errors), spec
        for _, lobes in same[1:]:
            assert np.linalg.norm(lobes - same[0][1]) <= 3e-3 * np.linalg.norm(same[0][1]), spec
