"""What the panel says below its buttons."""

from types import SimpleNamespace

import bpy
import pytest
from rsibr.rsibr_addon.core.errors import SceneError
from rsibr.rsibr_addon.core.options import declared_options
from rsibr.rsibr_addon.device.screen_scale import ui_scale
from rsibr.rsibr_addon.files.kinds.registry import STORED, look_types
from rsibr.rsibr_addon.settings.radiance_views import RadianceViewsSettings
from rsibr.rsibr_addon.ui import advanced_panel, preview_panel, result_panel, sentences
from rsibr.rsibr_addon.ui.sentences import LONG_LABEL_SHARE, LONGEST_LABEL, letters_in, panel_width, tell

NARROW = 292
"""Pixels of the sidebar's width that Blender begins with."""


@pytest.mark.parametrize("offline", [True, False])
def test_it_says_why_nothing_can_be_sent(offline: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    def check_online() -> None:
        if offline:
            raise SceneError("Blender may not use the network: switch on Allow Online Access.")

    told: list[str] = []
    column = SimpleNamespace(label=lambda text, icon: told.append(text))
    monkeypatch.setattr(preview_panel, "check_online", check_online)
    preview_panel._draw_offline(SimpleNamespace(column=lambda align: column), 300)
    assert " ".join(told).startswith("Blender may not use the network: switch on" if offline else "")
    assert bool(told) == offline


@pytest.mark.usefixtures("panel")
@pytest.mark.parametrize(
    ("kind", "settings", "told"),
    [
        ("mip_chain", {}, "Mip Chain"),
        ("lobe_stack", {"source": "MODEL"}, "Lobe Stack: Brushed copper"),
        ("lobe_stack", {"source": "MODEL", "brdf": "no model"}, "Lobe Stack: no model"),
        ("lobe_stack", {"source": "OWN"}, "Lobe Stack: Material"),
        ("radiance_views", {"source": "OWN"}, "Radiance Views: Material"),
    ],
)
def test_the_material_that_is_baked_is_named(kind: str, settings: dict[str, str], told: str) -> None:
    chosen = bpy.context.scene.rsibr_bake
    chosen.kind = kind
    for name, value in settings.items():
        setattr(getattr(chosen, kind), name, value)
    assert preview_panel._shaded_as(bpy.context) == told


@pytest.mark.usefixtures("panel")
def test_errors_that_were_measured_are_told_before_a_bake() -> None:
    chosen, told = bpy.context.scene.rsibr_bake, []
    chosen.kind = "radiance_views"
    column = SimpleNamespace(label=lambda text, icon: told.append(text))
    known = {name: getattr(bpy.context, name) for name in ("scene", "object", "preferences")}
    context = SimpleNamespace(region=SimpleNamespace(width=1000), **known)
    preview_panel._draw_request(SimpleNamespace(column=lambda align: column), context)
    assert RadianceViewsSettings(material="copper").expected in " ".join(told)


@pytest.mark.parametrize("kind", STORED)
def test_labels_fit_into_a_narrow_sidebar(kind: str) -> None:
    settings = STORED[kind].settings
    for each in advanced_panel._shown(settings):
        if each.wanted is not bool:  # these stand beside their box, where there is more room
            assert len(advanced_panel._label(each)) <= LONGEST_LABEL
    share = LONG_LABEL_SHARE / 0.4  # of what Blender gives the others
    for each in declared_options(look_types()[kind]):
        if each.wanted is not bool:
            assert len(each.option.label) <= share * (LONGEST_LABEL + 1)


@pytest.mark.parametrize(
    ("name", "fact", "lines"),
    [
        ("Error, interpolation", "0.0007", [["Error, interpolation", "0.0007"]]),
        (
            "Measured: paper, area",
            "13 %, at worst 25 %",
            [["Measured: paper, area"], ["13 %, at worst 25 %"]],
        ),
        (
            "Against",
            "Cycles at 64 samples and without denoising, 20 views",
            [["Against"], ["Cycles at 64 samples and without"], ["denoising, 20 views"]],
        ),
    ],
)
def test_a_fact_is_beside_its_name_or_below_it(name: str, fact: str, lines: list[list[str]]) -> None:
    told: list[list[str]] = []

    def row() -> SimpleNamespace:
        told.append([])
        part = SimpleNamespace(label=lambda text: told[-1].append(text))
        part.row = lambda: part
        return part

    below = SimpleNamespace(label=lambda text, icon: told.append([text]))
    result_panel._draw_facts(SimpleNamespace(row=row, column=lambda align: below), {name: fact}, NARROW)
    assert told == lines


def test_a_long_name_is_broken_rather_than_cut_off() -> None:
    told: list[str] = []
    column = SimpleNamespace(label=lambda text, icon: told.append(text))
    name = "a_mirror_ball_photographed_in_the_garden.exr"
    tell(SimpleNamespace(column=lambda align: column), f"{name} is 256x256: convert it.", NARROW)
    assert max(map(len, told)) <= letters_in(NARROW) < len(name)
    assert "".join(told).replace(" ", "") == f"{name}is256x256:convertit."


@pytest.mark.parametrize("icon", ["INFO", "NONE"])
def test_broken_lines_begin_below_each_other(icon: str) -> None:
    icons: list[str] = []
    column = SimpleNamespace(label=lambda text, icon: icons.append(icon))
    tell(SimpleNamespace(column=lambda align: column), "one two " * 20, NARROW, icon=icon)
    assert len(icons) > 1
    assert set(icons[1:]) == {"NONE" if icon == "NONE" else "BLANK1"}


@pytest.mark.parametrize("scale", [1.0, 2.0])
def test_as_many_letters_fit_at_every_scale_of_the_screen(
    scale: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sentences, "ui_scale", lambda: scale)
    assert panel_width(SimpleNamespace(region=SimpleNamespace(width=scale * NARROW))) == NARROW


def test_without_a_window_the_scale_is_blenders_own() -> None:
    assert ui_scale() == 1.0
