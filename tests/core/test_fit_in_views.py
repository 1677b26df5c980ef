"""A fit beside captured views: what it shows there is what its lobes reflect of the light."""

from dataclasses import replace

import numpy as np
import pytest
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.geometry.directions import reflect
from rsibr.rsibr_addon.core.kinds.radiance_views.views import RadianceViews
from rsibr.rsibr_addon.core.lobes.bake import filter_environment
from rsibr.rsibr_addon.core.lobes.bank import KernelBank
from rsibr.rsibr_addon.core.lobes.captured_light import CapturedLight, captured_light
from rsibr.rsibr_addon.core.lobes.captured_texels import captured_texels
from rsibr.rsibr_addon.core.lobes.fit import Fit
from rsibr.rsibr_addon.core.lobes.fit_in_views import TEXELS, error_in_views, fit_radiance
from rsibr.rsibr_addon.core.maps import equirect

BANK = KernelBank((2.0, 16.0))
HEIGHT, LOBES, SLICES, TAPS = 32, 2, 3, 2
RADIANCE = np.random.default_rng(1).random((HEIGHT, 2 * HEIGHT, 3)) ** 4


@pytest.fixture(scope="module")
def light() -> CapturedLight:
    return captured_light(
        RADIANCE, BANK, lambda radiance, bank: filter_environment(radiance, bank, "octahedral", 128)
    )


@pytest.fixture(scope="module", params=[1, SLICES])
def fit(request: pytest.FixtureRequest) -> Fit:
    """Lobes off the mirror direction and its plane, of one profile or of one for each elevation."""
    rng = np.random.default_rng(2)
    return Fit(
        "captured",
        "joint",
        np.array([0.3, 0.6, 0.9]),
        BANK,
        rng.random((LOBES, request.param, len(BANK), 3)),
        rng.random((LOBES, SLICES, 3)),
        0.2 * rng.normal(size=(LOBES, SLICES, TAPS, 2)),
        rng.random((LOBES, SLICES, TAPS)),
    )


def test_texels_show_what_lobes_reflect(light: CapturedLight, fit: Fit) -> None:
    views = RadianceViews(*np.zeros((2, 12, 8, 8, 3), dtype=np.float32))
    texels = captured_texels(views, 12, 12, np.empty((0, 3)))
    towards = equirect.direction_from_uv(texel_centres(2 * HEIGHT, HEIGHT)).reshape(-1, 3)
    weight = equirect.texel_solid_angle(2 * HEIGHT, HEIGHT) * np.ones((HEIGHT, 2 * HEIGHT))
    arriving = weight.reshape(-1, 1) * RADIANCE.reshape(-1, 3)
    shown = []
    for normal, view_dir, mu in zip(texels.normal, texels.view_dir, texels.mu, strict=True):
        # The fit's own axes: the normal is +Z, and the mirror direction in the plane of x and z
        mirror = reflect(view_dir, normal)
        x = (mirror - mu * normal) / np.sqrt(1.0 - mu**2)
        local = towards @ np.stack([x, np.cross(normal, x), normal], axis=1)
        shown.append(np.sum(fit.evaluate(local, mu) * arriving, axis=0))
    # Lookups between texels of 128 across
    np.testing.assert_allclose(fit_radiance(fit, light, texels), texels.means(np.array(shown)), rtol=2e-3)


def test_the_error_is_relative_to_what_was_captured(light: CapturedLight, fit: Fit) -> None:
    views = RadianceViews(*np.random.default_rng(3).random((2, 12, 8, 8, 3), dtype=np.float32))
    black = replace(fit, scale=np.zeros_like(fit.scale))
    assert error_in_views(black, light, views) == pytest.approx(1.0, rel=1e-12)
    dim = replace(fit, scale=1e-3 * fit.scale)
    texels = captured_texels(views, 12, TEXELS, light.suns.direction)
    rest = fit_radiance(dim, light, texels) - texels.diffuse - texels.glossy
    captured = texels.diffuse + texels.glossy
    # No sun stands out of this light, so all texels count alike
    assert error_in_views(dim, light, views) == pytest.approx(
        np.sqrt(np.sum(rest**2) / np.sum(captured**2)), rel=1e-9
    )
