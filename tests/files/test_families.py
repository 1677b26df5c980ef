"""The family of lobes that comes with us: as accurate as the page says, and as its command makes it."""

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf.albedo import directional_albedo
from rsibr.rsibr_addon.core.brdf.cook_torrance import CookTorrance
from rsibr.rsibr_addon.core.brdf.fresnel import Fresnel, Index, Schlick
from rsibr.rsibr_addon.core.brdf.fresnel_powers import dielectric, schlick
from rsibr.rsibr_addon.core.brdf.ggx import Ggx, ggx_ndf, smith_visibility
from rsibr.rsibr_addon.core.brdf.model import Brdf
from rsibr.rsibr_addon.core.brdf.ward import Ward
from rsibr.rsibr_addon.core.errors import InputFileError
from rsibr.rsibr_addon.core.lobes.accuracy import fit_errors
from rsibr.rsibr_addon.core.lobes.family import Family
from rsibr.rsibr_addon.core.lobes.family_fit import (
    WIDTHS,
    fit_closer_gaussian,
    fit_closer_ggx,
    fit_gaussian,
    fit_ggx,
)
from rsibr.rsibr_addon.core.progress import Steps, drain
from rsibr.rsibr_addon.files import families
from rsibr.rsibr_addon.files.families import read_family, shipped_family, shipped_sheen, write_family

PAGE = (Path(__file__).parents[2] / "docs" / "materials.md").read_text(encoding="utf-8")
TERMS = {
    "white metal": (Schlick(f0=1.0), schlick(1.0)),
    "F0 = .04": (Schlick(f0=0.04), schlick(0.04)),
    "glass, 1.5": (Index(eta=1.5), dielectric(1.5)),
    "water, 1.33": (Index(eta=1.33), dielectric(1.33)),
}


def error(family: Family, alpha: float, fresnel: Fresnel, coefficients: np.ndarray) -> float:
    fit = family.fit(alpha, np.repeat(coefficients[:, None], 3, axis=1), "ggx")
    return fit_errors(fit, Ggx(alpha=alpha, fresnel=fresnel)).error


@pytest.mark.parametrize("row", [24, 36])
def test_its_errors_are_those_of_the_page(row: int) -> None:
    family = shipped_family("ggx")
    alpha = float(family.alpha[row])
    (told,) = re.findall(rf"^\| {alpha:.3f} \| (.*) \|$", PAGE, re.MULTILINE)
    for text, term in zip(told.split(" | "), TERMS.values(), strict=False):
        # The page rounds to three digits
        assert error(family, alpha, *term) == pytest.approx(float(text), abs=6e-4)


@pytest.mark.slow
def test_a_width_fitted_anew_is_as_good() -> None:
    family = shipped_family("ggx")
    widths = WIDTHS[36:37]
    made = drain(fit_ggx(widths))
    for alpha in widths:
        for term in (TERMS["white metal"], TERMS["water, 1.33"]):
            # Fewer neighbours smooth the tilts, so they differ a little
            assert error(made, alpha, *term) == pytest.approx(error(family, alpha, *term), rel=0.1)


@pytest.mark.slow
def test_wards_and_beckmanns_lobes_fitted_anew_are_as_good() -> None:
    family = shipped_family("gaussian")
    alpha = float(family.alpha[10])
    made = drain(fit_gaussian(family.alpha[9:11]))
    models = {
        (1.0, 0.0, 0.0): Ward(alpha=alpha, ks=1.0),
        (0.0, 0.04, 0.96): CookTorrance(alpha=alpha, fresnel=Schlick(f0=0.04)),
    }
    for coefficients, model in models.items():
        of_all = np.repeat(np.array(coefficients)[:, None], 3, axis=1)
        ours, shipped = (fit_errors(each.fit(alpha, of_all, "model"), model).error for each in (made, family))
        assert shipped < 0.2
        # Fewer neighbours smooth the tilts, so they differ a little
        assert ours == pytest.approx(shipped, rel=0.1)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "closer", "model", "coefficients"),
    [
        ("ggx", fit_closer_ggx, Ggx(alpha=0.1, fresnel=Schlick(f0=1.0)), schlick(1.0)),
        ("gaussian", fit_closer_gaussian, Ward(alpha=0.1, ks=1.0), np.array([1.0, 0.0, 0.0])),
    ],
)
def test_closer_lobes_of_one_width_are_closer_at_grazing(
    name: str, closer: Callable[[float], Steps[Family]], model: Brdf, coefficients: np.ndarray
) -> None:
    of_all = np.repeat(coefficients[:, None], 3, axis=1)
    shipped, ours = (
        fit_errors(family.fit(0.1, of_all, name), model)
        for family in (shipped_family(name), drain(closer(0.1)))
    )
    # Half as many lobes again; what captures do not tell is as wrong as this
    assert ours.grazing_error < 0.75 * shipped.grazing_error
    assert ours.error < 0.75 * shipped.error
    # The limit of joint fits, by another quadrature
    assert ours.amplification.max() < 8.1


def test_peaks_are_right_halfway_between_widths_and_elevations() -> None:
    family = shipped_family("ggx")
    white = family.weights @ schlick(1.0)
    for alpha in np.sqrt(family.alpha[6:30:2] * family.alpha[7:31:2]):
        for mu in (22.0 / 32.0, 26.0 / 32.0, 30.0 / 32.0):
            theta = np.arccos(mu)
            angles = theta - family.at(family.tilts, alpha, mu) * np.sin(theta)
            kernels = family.bank.values(np.sin(0.5 * (angles - theta)) ** 2)
            peak = np.sum(family.at(white, alpha, mu) * kernels)
            exact = mu * ggx_ndf(0.0, alpha) * smith_visibility(mu, mu, alpha)
            # Kernels in steps of 4 leave .5 %, steps of an octave's sixth in alpha as much again
            assert peak == pytest.approx(exact, rel=0.02)


def test_albedos_are_sums_of_weights() -> None:
    family = shipped_family("ggx")
    for row in (24, 36, 48):
        for fresnel, coefficients in (TERMS["white metal"], TERMS["F0 = .04"]):
            exact = directional_albedo(Ggx(alpha=family.alpha[row], fresnel=fresnel), family.mu)[:, 0]
            # What the page says of the family at grazing; the quadrature of `directional_albedo` errs by 5e-4
            np.testing.assert_allclose(family.albedo[row] @ coefficients, exact, rtol=3e-3)


def test_a_family_comes_back_as_it_was_written(tmp_path: Path) -> None:
    family = shipped_family("ggx")
    write_family(tmp_path / "again.npz", family)
    again = read_family(tmp_path / "again.npz")
    assert again.bank == family.bank
    for name in ("alpha", "mu", "tilts", "weights"):
        np.testing.assert_array_equal(getattr(again, name), getattr(family, name))


def test_another_file_is_no_family(tmp_path: Path) -> None:
    path = tmp_path / "family.npz"
    for content in (b"", b"no arrays", b"PK\x05\x06" + bytes(18)):
        path.write_bytes(content)
        with pytest.raises(InputFileError, match=r"is no family of lobes: install RSIBR again"):
            read_family(path)
    with pytest.raises(InputFileError, match=r"is no family of lobes"):
        read_family(tmp_path / "missing.npz")


def test_another_file_is_no_table_of_sheen(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(families, "SHIPPED", tmp_path)
    (tmp_path / "sheen.npz").write_bytes(b"no arrays")
    with pytest.raises(InputFileError, match=r"sheen\.npz is no table of sheen: install RSIBR again"):
        shipped_sheen.__wrapped__()
