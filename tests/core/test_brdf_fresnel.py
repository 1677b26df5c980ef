"""Fresnel reflectance, spectra as colours, and metals between the two."""

import csv

import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf.fresnel import Index, Schlick, fresnel_conductor, fresnel_schlick
from rsibr.rsibr_addon.core.brdf.metals import METALS
from rsibr.rsibr_addon.core.brdf.spectrum import REC709_FROM_XYZ, color_matching, rec709_from_spectrum
from rsibr.rsibr_addon.core.errors import RangeError
from rsibr.rsibr_addon.files.chromaticities import XYZ, rec709_from
from rsibr.tests.measurements import DATA

VISIBLE = np.arange(380.0, 781.0)


def test_normal_and_grazing_incidence() -> None:
    eta, k = np.array([0.2, 1.5, 4.0, 0.05]), np.array([3.9, 0.0, 5.0, 10.0])
    expected = ((eta - 1.0) ** 2 + k**2) / ((eta + 1.0) ** 2 + k**2)
    np.testing.assert_allclose(fresnel_conductor(1.0, eta, k), expected, rtol=1e-12)
    np.testing.assert_allclose(fresnel_conductor(0.0, eta, k), 1.0, rtol=1e-12)


def test_a_dielectric_obeys_snells_law() -> None:
    cosine = np.linspace(0.01, 1.0, 200)
    for eta in (1.33, 1.5, 2.4):
        refracted = np.sqrt(1.0 - (1.0 - cosine**2) / eta**2)
        perpendicular = ((cosine - eta * refracted) / (cosine + eta * refracted)) ** 2
        parallel = ((eta * cosine - refracted) / (eta * cosine + refracted)) ** 2
        np.testing.assert_allclose(
            fresnel_conductor(cosine, eta, 0.0), (perpendicular + parallel) / 2.0, rtol=1e-10
        )


def test_the_complex_index_in_complex_arithmetic() -> None:
    cosine = np.linspace(0.0, 1.0, 101)[:, None]
    eta, k = np.array([0.2, 0.92, 1.1, 0.01, 8.0]), np.array([3.9, 2.45, 2.1, 30.0, 0.3])
    index = eta + 1j * k
    refracted = np.sqrt(index**2 - (1.0 - cosine**2))
    perpendicular = np.abs((cosine - refracted) / (cosine + refracted)) ** 2
    parallel = np.abs((index**2 * cosine - refracted) / (index**2 * cosine + refracted)) ** 2
    # Differences of numbers close to 1 lose some digits at small k
    np.testing.assert_allclose(fresnel_conductor(cosine, eta, k), (perpendicular + parallel) / 2.0, rtol=1e-9)


def test_from_glass_to_air_all_is_reflected_beyond_the_critical_angle() -> None:
    critical = np.sqrt(1.0 - (1.0 / 1.5) ** 2)
    assert fresnel_conductor(critical - 0.01, 1.0 / 1.5, 0.0) == pytest.approx(1.0, rel=1e-12)
    assert fresnel_conductor(critical + 0.01, 1.0 / 1.5, 0.0) < 0.8


def test_schlick_meets_both_ends_and_approximates_glass() -> None:
    assert fresnel_schlick(1.0, 0.3, 0.8) == 0.3
    assert fresnel_schlick(0.0, 0.3, 0.8) == 0.8
    cosine = np.linspace(0.0, 1.0, 101)
    exact = fresnel_conductor(cosine, 1.5, 0.0)
    # [Schlick1994] section 3: the mean error is about a percent of full reflectance
    assert np.mean(np.abs(fresnel_schlick(cosine, 0.04) - exact)) < 0.02
    np.testing.assert_array_equal(Schlick(f0=0.04)(cosine)[:, 1], fresnel_schlick(cosine, 0.04))
    np.testing.assert_array_equal(Index(eta=(1.5, 2.0, 3.0))(cosine)[:, 0], exact)


def test_colour_matching_functions_have_their_known_peaks() -> None:
    x, y, z = color_matching(VISIBLE).T
    # CIE 1931: y is 1 at 555 nm, x peaks at 599 with 1.06, z at 446 with 1.78; the fit is good to 1-2 %
    assert VISIBLE[np.argmax(y)] == pytest.approx(555.0, abs=5.0)
    assert y.max() == pytest.approx(1.0, abs=0.02)
    assert x.max() == pytest.approx(1.06, abs=0.02)
    assert z.max() == pytest.approx(1.78, abs=0.04)
    # All three have the same integral, about 106.9 nm, so that equal energy is white
    np.testing.assert_allclose(color_matching(VISIBLE).sum(axis=0), 106.9, rtol=3e-3)


def test_the_matrix_is_the_one_that_files_are_converted_with() -> None:
    np.testing.assert_allclose(rec709_from(XYZ), REC709_FROM_XYZ, rtol=0, atol=1e-8)


def test_flat_spectra_are_grey_and_narrow_ones_have_their_hue() -> None:
    wavelength = np.array([400.0, 430.0, 500.0, 640.0, 700.0])
    flat = np.array([0.0, 0.3, 2.0])[:, None] * np.ones(5)
    np.testing.assert_allclose(rec709_from_spectrum(wavelength, flat), flat[:, :3], rtol=0, atol=1e-7)
    red, green, blue = (np.exp(-(((VISIBLE - centre) / 20.0) ** 2)) for centre in (620.0, 540.0, 455.0))
    colors = rec709_from_spectrum(VISIBLE, [red, green, blue])
    np.testing.assert_array_equal(np.argmax(colors, axis=1), [0, 1, 2])
    assert (colors.min(axis=1) < 0.0).all()  # such pure colours are outside the gamut


def test_spectra_are_linear_between_wavelengths() -> None:
    coarse = np.array([400.0, 450.0, 520.0, 700.0])
    values = np.array([0.1, 0.7, 0.3, 0.9])
    fine = np.linspace(400.0, 700.0, 3001)
    np.testing.assert_allclose(
        rec709_from_spectrum(coarse, values),
        rec709_from_spectrum(fine, np.interp(fine, coarse, values)),
        rtol=1e-3,  # kinks between two of the points of integration
    )


@pytest.mark.parametrize("wavelength", [[500.0], [400.0, 400.0], [500.0, 400.0]])
def test_a_spectrum_needs_increasing_wavelengths(wavelength: list[float]) -> None:
    with pytest.raises(RangeError, match="increasing order"):
        rec709_from_spectrum(wavelength, np.ones(len(wavelength)))


@pytest.fixture(params=METALS)
def metal(request: pytest.FixtureRequest) -> tuple[str, np.ndarray, np.ndarray]:
    """A metal's name, and its optical constants at every visible nanometre."""
    with (DATA / "metals.csv").open() as stream:
        rows = [row for row in csv.DictReader(stream) if row["metal"] == request.param]
    wavelength, eta, k = (
        np.array([float(row[name]) for row in rows]) for name in ("wavelength_nm", "eta", "k")
    )
    return request.param, np.interp(VISIBLE, wavelength, eta), np.interp(VISIBLE, wavelength, k)


def test_metals_are_their_optical_constants_as_colours(metal: tuple[str, np.ndarray, np.ndarray]) -> None:
    name, eta, k = metal
    # Stored with four decimals
    np.testing.assert_allclose(METALS[name].eta, rec709_from_spectrum(VISIBLE, eta), rtol=0, atol=6e-5)
    np.testing.assert_allclose(METALS[name].k, rec709_from_spectrum(VISIBLE, k), rtol=0, atol=6e-5)


def test_metals_have_the_colour_of_their_spectral_reflectance(
    metal: tuple[str, np.ndarray, np.ndarray],
) -> None:
    name, eta, k = metal
    for cosine in (1.0, 0.7, 0.4, 0.2, 0.1):
        spectral = rec709_from_spectrum(VISIBLE, fresnel_conductor(cosine, eta, k))
        ours = METALS[name](np.array([cosine]))[0]
        # An index per channel is an approximation; its docstring promises this much
        np.testing.assert_allclose(ours, np.minimum(spectral, 1.0), rtol=0, atol=0.03)
