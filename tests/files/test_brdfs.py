"""Reflectance models by text, files included."""

import re
import warnings
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf.albedo import directional_albedo
from rsibr.rsibr_addon.core.brdf.cook_torrance import CookTorrance
from rsibr.rsibr_addon.core.brdf.fresnel import Schlick
from rsibr.rsibr_addon.core.brdf.ward import Ward
from rsibr.rsibr_addon.core.errors import InputFileError, RangeError, RsibrWarning
from rsibr.rsibr_addon.files.brdfs import brdf_from_spec
from rsibr.tests.measurements import DATA


def test_models_without_files_need_none() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert brdf_from_spec("ward:alpha=0.04,ks=0.8") == Ward(alpha=0.04, ks=0.8)
    with pytest.raises(RangeError, match="ward: alpha is 2"):
        brdf_from_spec("ward:alpha=2,ks=1")


@pytest.mark.parametrize("measured_format", ["merl", "cornell", "rgl"])
def test_each_format_has_its_reader(tmp_path: Path, measured_format: str) -> None:
    path = tmp_path / "a.file"
    with pytest.raises(InputFileError, match="does not exist"):
        brdf_from_spec(f"{measured_format}:path={path}")
    path.write_bytes(b"something else")
    words = {"merl": "MERL", "cornell": "Cornell", "rgl": "RGL"}
    with pytest.raises(InputFileError, match=words[measured_format]):
        brdf_from_spec(f"layered:coat=(ggx:alpha=0.1,eta=1.5),base=({measured_format}:path={path})")


def test_gain_is_warned_of() -> None:
    with pytest.warns(RsibrWarning, match=r"^phong:n=1,ks=1,kd=1 reflects 1\.\d+ times the light"):
        brdf_from_spec("phong:n=1,ks=1,kd=1")


def published_fits(name: str) -> dict[str, list[list[float]]]:
    """Material -> diffuse colour, glossy colour, and the scalars that follow."""
    lines = [
        line
        for line in (DATA / "fits" / name).read_text().splitlines()
        if "=" in line and not line.startswith("#")
    ]
    fits = {}
    for line in lines:
        material, _, text = line.partition(" = ")
        colors = re.findall(r"\[([^]]*)\]", text)
        scalars = re.findall(r"(?:eta|roughness) = ([\d.e-]+)", text)
        fits[material] = [[float(x) for x in part.split(",")] for part in (*colors, ",".join(scalars))]
    return fits


def test_published_ward_fits_are_in_range_and_keep_energy() -> None:
    fits = published_fits("ngan_ward.fit")
    assert len(fits) > 80
    for kd, ks, (alpha,) in list(fits.values())[::3]:
        brdf = Ward(alpha=alpha, ks=ks, kd=kd)
        albedo = directional_albedo(brdf, [0.9, 0.5])
        assert albedo.max() < 1.0
        # Diffuse and glossy parts of a narrow lobe add up; a wide one loses below the horizon
        assert (albedo <= np.add(kd, ks) + 1e-4).all()


def test_published_fits_of_two_models_agree_at_the_top_of_the_lobe() -> None:
    # [Ngan2005] fitted Ward and Cook-Torrance to the same materials; their Cook-Torrance has 1 / pi where
    # ours has 1 / 4. Seen from above, narrow metals must then have the same height
    ward, cook_torrance = published_fits("ngan_ward.fit"), published_fits("ngan_cooktorrance.fit")
    top, ratios = np.array([0.0, 0.0, 1.0]), []
    for material in ("aluminium", "brass", "chrome-steel", "blue-metallic-paint2", "gold-metallic-paint2"):
        _, ks, (alpha,) = ward[material]
        height = Ward(alpha=alpha, ks=ks)(top, top)
        _, ks, (f0, alpha) = cook_torrance[material]
        brdf = CookTorrance(alpha=alpha, fresnel=Schlick(f0=f0), ks=ks)
        ratios.append(4.0 / np.pi * brdf(top, top) / height)
    # Two fits of one measurement in different shapes
    np.testing.assert_allclose(ratios, 1.0, atol=0.2)
