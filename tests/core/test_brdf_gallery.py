"""Every model of the gallery is one, and takes from light no more than there is."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf.albedo import directional_albedo
from rsibr.rsibr_addon.core.brdf.car_paint import PAINTS
from rsibr.rsibr_addon.core.brdf.gallery import GALLERY, gallery_name
from rsibr.rsibr_addon.core.brdf.spec import brdf_from_spec


def no_files(name: str, path: str) -> None:
    raise AssertionError(path)


@pytest.mark.parametrize("spec", [spec for models in GALLERY.values() for spec in models.values()])
def test_a_model_reflects_some_light_and_no_more_than_all(spec: str) -> None:
    albedo = directional_albedo(brdf_from_spec(spec, no_files), np.array([0.9, 0.5]))
    assert np.all(albedo > 0.0)
    # A white furnace's quadrature, and the paints' and Ward's own gain, stay below this
    assert np.all(albedo < 1.01)


def test_all_measured_car_paints_are_there() -> None:
    assert {f"car_paint:name={name}" for name in PAINTS} == set(GALLERY["Car paints"].values())


@pytest.mark.parametrize(
    ("spec", "name"),
    [
        ("ggx:alpha=0.3,metal=copper", "Brushed copper"),
        ("ggx:alpha=0.31,metal=copper", "ggx:alpha=0.31,metal=copper"),
        ("blend:car-paint", "Car Paint"),
        ("blend::Velvet: red", "Velvet: red"),
        ("blend:/tmp/a.blend:Velvet", "Velvet"),
    ],
)
def test_people_read_names(spec: str, name: str) -> None:
    assert gallery_name(spec) == name
