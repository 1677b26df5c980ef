"""The He-Torrance-Sillion-Greenberg model against values that others computed."""

import csv

import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf.albedo import directional_albedo
from rsibr.rsibr_addon.core.brdf.fresnel import Index, Schlick
from rsibr.rsibr_addon.core.brdf.he_torrance import HeTorrance, _lambert_w, _series
from rsibr.tests.measurements import DATA

WAVELENGTH = (0.65, 0.55, 0.45)

METALS = {
    "Al_s0.18_t3.0": HeTorrance(
        sigma=0.18,
        tau=3.0,
        fresnel=Index(eta=(1.49, 1.02, 0.64), k=(7.82, 6.63, 5.47)),
        wavelength=WAVELENGTH,
    ),
    "Cu_s0.13_t1.2": HeTorrance(
        sigma=0.13,
        tau=1.2,
        fresnel=Index(eta=(0.21, 1.05, 1.17), k=(3.67, 2.58, 2.40)),
        wavelength=WAVELENGTH,
    ),
}
"""Indices at 650, 550 and 450 nm that the reference was made with: its Fresnel factor shows them to 1e-6."""


@pytest.fixture(scope="module")
def rows() -> list[dict[str, str]]:
    """Lines of the reference: two metals, light and view elevations, azimuths."""
    with (DATA / "he_torrance.csv").open() as stream:
        return list(csv.DictReader(stream))


def column(rows: list[dict[str, str]], name: str) -> np.ndarray:
    return np.array([float(row[name]) for row in rows])


@pytest.mark.parametrize("metal", METALS)
def test_the_exact_series_is_reproduced(rows: list[dict[str, str]], metal: str) -> None:
    chosen = [row for row in rows if row["set"] == metal]
    theta_i, theta_r, azimuth = (
        np.radians(column(chosen, name)) for name in ("theta_i_deg", "theta_r_deg", "phi_from_mirror_deg")
    )
    light_dir = np.stack([-np.sin(theta_i), np.zeros_like(theta_i), np.cos(theta_i)], axis=-1)
    view_dir = np.stack(
        [np.sin(theta_r) * np.cos(azimuth), np.sin(theta_r) * np.sin(azimuth), np.cos(theta_r)], axis=-1
    )
    expected = np.stack([column(chosen, f"exact_rho_dd_{nm}") for nm in (650, 550, 450)], axis=-1)
    # Seven digits are written, of values from 20 down to 1e-34
    np.testing.assert_allclose(METALS[metal](light_dir, view_dir), expected, rtol=1e-6)


@pytest.mark.parametrize("metal", METALS)
def test_the_mirror_image_is_dimmed_as_in_the_reference(rows: list[dict[str, str]], metal: str) -> None:
    chosen = [row for row in rows if row["set"] == metal]
    expected = np.stack([column(chosen, f"rho_s_{nm}") for nm in (650, 550, 450)], axis=-1)
    cosine = np.cos(np.radians(column(chosen, "theta_i_deg")))
    np.testing.assert_allclose(METALS[metal].mirror_reflectance(cosine), expected, rtol=1e-5)


def test_where_light_and_view_meet_the_value_is_the_limit() -> None:
    brdf = HeTorrance(sigma=0.18, tau=3.0, fresnel=Schlick(f0=1.0))
    view = np.array([np.sin(0.5), 0.0, np.cos(0.5)])
    beside = np.array([np.sin(0.5 + 1e-7), 0.0, np.cos(0.5 + 1e-7)])
    np.testing.assert_allclose(brdf(view, view), brdf(beside, view), rtol=1e-5)


@pytest.mark.parametrize("g", [1e-6, 0.3, 7.0, 60.0, 700.0])
@pytest.mark.parametrize("c", [0.0, 2.0, 300.0, 1e5])
def test_the_series_is_summed_to_its_end(g: float, c: float) -> None:
    # In logarithms over so many terms that the rest is below 1e-300 of them
    m = np.arange(1, 20_001)
    log_term = m * np.log(g) - g - np.cumsum(np.log(m)) - np.log(m) - c / m
    expected = np.exp(log_term.max()) * np.sum(np.exp(log_term - log_term.max()))
    # Logarithms of up to 5,000 lose four digits of sixteen; a series that starts below 1e-308 is given up
    np.testing.assert_allclose(_series(np.array([g]), np.array([c])), expected, rtol=1e-10, atol=1e-100)


def test_lambert_w_is_an_inverse() -> None:
    w = np.concatenate([[0.0], np.geomspace(1e-12, 80.0, 300)])
    np.testing.assert_allclose(_lambert_w(w * np.exp(w)), w, rtol=1e-12)


def test_a_rougher_surface_dims_the_mirror_and_keeps_the_energy() -> None:
    perfect = Schlick(f0=1.0)
    for sigma in (0.02, 0.05, 0.1):
        brdf = HeTorrance(sigma=sigma, tau=5.0, fresnel=perfect)
        total = directional_albedo(brdf, 0.9) + brdf.mirror_reflectance([0.9])[0]
        # Gentle slopes hide nothing: what the mirror image loses is scattered, [He1991] section 2.3
        np.testing.assert_allclose(total, 1.0, atol=5e-3)
    dimmed = [
        HeTorrance(sigma=s, tau=5.0, fresnel=perfect).mirror_reflectance([0.9]) for s in (0.02, 0.05, 0.1)
    ]
    assert np.all(np.diff(dimmed, axis=0) < 0.0)
    assert np.all(np.diff(dimmed[0]) < 0.0)  # red light has the longest waves and sees the least roughness
