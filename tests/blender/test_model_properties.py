"""Sliders, colours and curves of options that name a model, against the texts that they are."""

from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.core.kinds.reflection_tables.material import (
    MODELS,
    PARTS,
    PRESETS,
    material_from_texts,
)
from rsibr.rsibr_addon.core.kinds.reflection_tables.shading import TablesLook
from rsibr.rsibr_addon.core.options import declared_options
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance
from rsibr.rsibr_addon.host.model_properties import NONE, shown_keys, take_curves, text_of_curves
from rsibr.rsibr_addon.host.option_properties import options_of
from rsibr.rsibr_addon.host.plain_settings import apply_settings, plain_settings
from rsibr.rsibr_addon.settings.reflection_tables import ReflectionTablesSettings

pytestmark = pytest.mark.usefixtures("registered")

DECLARED = {each.name: each for each in declared_options(ReflectionTablesSettings) if each.option.models}


def group() -> Any:
    return bpy.context.scene.rsibr_bake.reflection_tables


def parts() -> dict[str, str]:
    return dict(options_of(ReflectionTablesSettings, group()).parts)


@pytest.mark.parametrize("name", PRESETS)
def test_a_preset_is_shown_as_values_of_its_parts_and_stays_what_it_is(name: str) -> None:
    shown = group()
    shown.preset = name
    for part, declared in DECLARED.items():
        if part != "emission":
            expected = PRESETS[name].get(part, NONE).partition(":")[0]
            assert getattr(shown, f"{part}_model") == expected
        for key in shown_keys(declared, shown):
            setattr(shown, key, getattr(shown, key))  # as it is, in single precision
    assert parts() == PRESETS[name]


def test_a_slider_changes_the_text_of_its_part_alone() -> None:
    shown = group()
    shown.preset = "varnished-wood"
    assert tuple(shown.diffuse_kd) == pytest.approx((0.35, 0.15, 0.05))
    shown.specular_n, shown.coat_metal = 33.0, "gold"
    shown.diffuse_kd = (0.1, 0.2, 0.3)
    assert parts() == PRESETS["varnished-wood"] | {
        "specular": "phong:ks=0.3,n=33",
        "coat": "fresnel:metal=gold",
        "diffuse": "lambert:kd=0.1/0.2/0.3",
    }
    shown.coat_model, shown.diffuse_model = NONE, "luminous"
    shown.emission_radiance = (1.0, 2.0, 0.5)
    assert parts() == {
        "diffuse": "luminous:kd=0.1/0.2/0.3",
        "specular": "phong:ks=0.3,n=33",
        "emission": "1/2/0.5",
    }


@pytest.mark.parametrize("part", MODELS)
def test_every_model_can_be_chosen_and_is_one(part: str) -> None:
    shown = group()
    shown.preset = "plastic"
    for owner in MODELS[part]:
        setattr(shown, f"{part}_model", owner.model)
        assert getattr(shown, f"{part}_model") == owner.model
        assert isinstance(getattr(material_from_texts(parts(), None), part), owner)


def test_a_look_shows_what_was_baked_until_it_says_otherwise(tmp_path: Path) -> None:
    light, path = tmp_path / "light.exr", tmp_path / "tables.rsibr.exr"
    write_radiance(light, np.ones((8, 16, 3), dtype=np.float32))
    words = ["--diffuse", "lambert:kd=0.5", "--coat", "fresnel:eta=1.25", "--progress", "none"]
    assert run(["bake", "reflection-tables", "--environment", str(light), *words, "-o", str(path)]) == 0
    cube = bpy.data.objects["Cube"]
    look = cube.rsibr.reflection_tables
    assert look.coat_model == NONE
    cube.rsibr.map_set = str(path)
    assert (look.coat_model, look.coat_eta, look.specular_model) == ("fresnel", 1.25, NONE)
    assert options_of(TablesLook, look) == TablesLook()
    look.coat_eta = 1.5
    assert options_of(TablesLook, look) == TablesLook(coat="fresnel:eta=1.5")
    look.coat = ""
    assert look.coat_eta == 1.25


def test_settings_that_are_copied_say_what_was_said_and_no_more() -> None:
    shown = group()
    shown.preset = "satin"
    shown.specular_n = 12.0
    plain = plain_settings(shown)
    assert not [name for name in plain if name.startswith("specular_")]
    other = bpy.data.objects["Cube"].rsibr_baked.reflection_tables
    apply_settings(other, plain)
    assert (other.diffuse, other.specular) == ("", "phong:ks=0.2,n=12")


def curves(owner: Any, name: str) -> Any:
    return owner.weights_curves.nodes[name].mapping


def test_curves_become_the_text_and_the_text_curves() -> None:
    shown, declared = group(), DECLARED["weights"]
    shown.weights = "curve:wd=0:0.2/1:1,ws=0:1/0.5:0.25/1:0.125"
    assert shown.weights_curves is None
    shown.weights_model = "fresnel"
    shown.weights_model = "curve"
    assert shown.weights == "curve:wd=0:1/1:1,ws=0:1/1:1"
    mapping = curves(shown, "ws")
    mapping.curves[0].points[1].location = (1.0, 0.5)
    mapping.update()
    take_curves(declared, shown)
    assert shown.weights == "curve:wd=0:1/1:1,ws=0:1/1:0.5"
    # A rounded curve is read so closely that its text is within a thousandth of it
    mapping.curves[0].points.new(0.4, 0.1)
    mapping.update()
    take_curves(declared, shown)
    weights = material_from_texts(parts(), None).weights
    at = np.linspace(0.0, 1.0, 257)
    drawn = [mapping.evaluate(mapping.curves[0], place) for place in at]
    np.testing.assert_allclose(weights.specular(at)[:, 0], np.maximum(drawn, 0.0), atol=2e-3)


def test_curves_of_a_copy_are_its_own() -> None:
    cube, declared = bpy.data.objects["Cube"], DECLARED["weights"]
    look = cube.rsibr.reflection_tables
    look.weights_model = "curve"
    copy = cube.copy()
    other = copy.rsibr.reflection_tables
    curves(other, "wd").curves[0].points[0].location = (0.0, 0.5)
    curves(other, "wd").update()
    take_curves(declared, other)
    assert other.weights == "curve:wd=0:0.5/1:1,ws=0:1/1:1"
    assert look.weights == text_of_curves(declared, look) == "curve:wd=0:1/1:1,ws=0:1/1:1"


def test_every_part_has_its_properties() -> None:
    assert set(DECLARED) == set(PARTS)
