"""Widths of lobes from their values, against models that state theirs."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf.lobe_width import measured_alpha, narrowest_alpha
from rsibr.rsibr_addon.core.brdf.model import Brdf
from rsibr.rsibr_addon.core.brdf.spec import brdf_from_spec
from rsibr.rsibr_addon.core.brdf.tabulated import DEFAULT_SHAPE, Tabulated, cell_directions


def model(spec: str) -> Brdf:
    return brdf_from_spec(spec, lambda name, path: pytest.fail(path))


def tabulated(spec: str) -> Tabulated:
    return Tabulated(model(spec)(*cell_directions(DEFAULT_SHAPE)), spec)


@pytest.mark.parametrize("alpha", [0.003, 0.04, 0.3])
def test_the_width_of_wards_lobe_is_its_alpha(alpha: float) -> None:
    # Angles between which the half height lies are 5 % apart; its 1 / cosines are flat only for narrow lobes
    assert measured_alpha(model(f"ward:alpha={alpha},ks=0.5,kd=0.02")) == pytest.approx(alpha, rel=0.1)


def test_the_width_of_ggx_is_that_at_half_its_height() -> None:
    # sqrt(2) - 1 = tan^2 / alpha^2 there, and a Gaussian's ln 2
    expected = 0.1 * np.sqrt((np.sqrt(2.0) - 1.0) / np.log(2.0))
    assert measured_alpha(model("ggx:alpha=0.1,metal=copper")) == pytest.approx(expected, rel=0.06)


def test_a_rough_surface_of_waves_is_as_wide_as_its_slopes() -> None:
    # Far rougher than the wavelength, He-Torrance becomes Beckmann's facets of slope 2 sigma / tau
    spec = "he_torrance:sigma=1,tau=10,metal=copper"
    assert narrowest_alpha(model(spec)) == pytest.approx(0.2, rel=0.1)


def test_a_table_is_as_wide_as_the_model_in_it() -> None:
    assert narrowest_alpha(tabulated("ward:alpha=0.1,ks=0.8")) == pytest.approx(0.1, rel=0.1)
    assert narrowest_alpha(tabulated("lambert:kd=0.5")) == 1.0


def test_a_lobe_lower_than_its_base_is_diffuse() -> None:
    assert measured_alpha(model("ward:alpha=0.3,ks=0.01,kd=0.5")) == 1.0
