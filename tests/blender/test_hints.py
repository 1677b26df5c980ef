"""What panels tell of Blender's own shading and of numbers, and which panels they name."""

from unittest.mock import Mock

import bpy
import pytest
from rsibr.rsibr_addon.core.options import declared_options
from rsibr.rsibr_addon.settings.kernel_bank import KernelBankSettings
from rsibr.rsibr_addon.settings.lobe_stack import LobeStackSettings
from rsibr.rsibr_addon.settings.method import MethodSettings
from rsibr.rsibr_addon.settings.mip_chain import MipChainSettings
from rsibr.rsibr_addon.settings.radiance_views import RadianceViewsSettings
from rsibr.rsibr_addon.settings.reflection_tables import ReflectionTablesSettings
from rsibr.rsibr_addon.ui import advanced_panel, look_panel, preview_panel
from rsibr.rsibr_addon.ui.sentences import SOLID


@pytest.mark.parametrize(
    ("kind", "scene_world", "told"),
    [
        ("SOLID", True, SOLID),
        ("MATERIAL", False, look_panel.STUDIO_LIGHT),
        ("MATERIAL", True, ""),
        ("RENDERED", False, look_panel.STUDIO_LIGHT),
        ("RENDERED", True, ""),
    ],
)
def test_a_comparison_tells_where_blender_shades_in_another_light(
    kind: str, scene_world: bool, told: str
) -> None:
    areas = bpy.data.screens["Layout"].areas
    shading = next(area.spaces[0].shading for area in areas if area.type == "VIEW_3D")
    before = shading.type, shading.use_scene_world, shading.use_scene_world_render
    try:
        shading.type = kind
        # The other mode's switch has no say
        shading.use_scene_world = scene_world if kind == "MATERIAL" else not scene_world
        shading.use_scene_world_render = scene_world if kind == "RENDERED" else not scene_world
        assert look_panel._other_light(shading) == told
    finally:
        shading.type, shading.use_scene_world, shading.use_scene_world_render = before


@pytest.mark.parametrize(
    ("kind", "engine", "opacity", "told"),
    [
        ("SOLID", "CYCLES", 0.0, SOLID),
        ("WIREFRAME", "CYCLES", 0.0, ""),
        ("MATERIAL", "CYCLES", 0.0, look_panel.LITTLE_LIGHT),
        ("MATERIAL", "CYCLES", 1.0, ""),
        ("RENDERED", "BLENDER_EEVEE", 0.0, ""),
        ("RENDERED", "CYCLES", 0.0, look_panel.NOT_LIGHT),
    ],
)
@pytest.mark.usefixtures("panel")
def test_look_tells_why_a_viewport_keeps_light_from_live_light(
    kind: str, engine: str, opacity: float, told: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    bpy.context.scene.render.engine = engine
    areas = bpy.data.screens["Layout"].areas
    space = next(area.spaces[0] for area in areas if area.type == "VIEW_3D")
    shading, tell = space.shading, Mock()
    monkeypatch.setattr(look_panel.session().previews, "kind", lambda item: None)
    monkeypatch.setattr(look_panel, "tell", tell)
    context = Mock(object=bpy.context.object, space_data=space, region=Mock(width=300))
    names = ("type", "use_scene_world", "use_scene_world_render", "studiolight_background_alpha")
    before = [getattr(shading, name) for name in names]
    try:
        for name, value in zip(names, (kind, False, True, opacity), strict=True):
            setattr(shading, name, value)
        for on in (False, True):  # nothing is told while the switch is off
            context.object.rsibr.live.on = on
            look_panel.RSIBR_PT_look.draw(Mock(), context)
            assert [call.args[1] for call in tell.call_args_list] == ([told] if on and told else [])
    finally:
        for name, value in zip(names, before, strict=True):
            setattr(shading, name, value)


@pytest.mark.parametrize(
    ("change", "kind", "told"),
    [
        ({}, "SOLID", ""),
        ({"display_type": "WIRE"}, "SOLID", "displayed without surfaces"),
        ({"display_type": "BOUNDS"}, "MATERIAL", "displayed without surfaces"),
        ({"display_type": "SOLID"}, "MATERIAL", ""),
        ({}, "WIREFRAME", "Wireframe shows no previews"),
    ],
)
@pytest.mark.usefixtures("panel")
def test_why_a_preview_is_not_seen_is_told(change: dict[str, object], kind: str, told: str) -> None:
    item, shading = bpy.context.object, Mock(type=kind)
    for name, value in change.items():
        setattr(item, name, value)
    said = preview_panel._why_unseen(item, shading)
    assert told in said
    assert bool(said) == bool(told)
    item.rsibr.show = False
    assert "Look is switched off" in preview_panel._why_unseen(item, shading)


def test_hints_name_panels_by_their_labels() -> None:
    look = f"in {look_panel.RSIBR_PT_look.bl_label}."
    assert look in MipChainSettings.REMARK
    assert look in KernelBankSettings.REMARK


@pytest.mark.parametrize(
    ("settings", "name", "label"),
    [
        (LobeStackSettings, "size", "Size (0: auto)"),
        (ReflectionTablesSettings, "rows", "Rows (0: auto)"),
        (MipChainSettings, "size", "Size"),
        (RadianceViewsSettings, "more_views", "More Views"),
    ],
)
def test_the_panel_says_that_a_size_of_0_is_chosen_by_itself(
    settings: type[MethodSettings], name: str, label: str
) -> None:
    layout, (option,) = Mock(), [each for each in declared_options(settings) if each.name == name]
    advanced_panel._draw_options(layout, Mock(), [option])
    layout.column().row().prop.assert_called_once()
    assert layout.column().row().prop.call_args.kwargs["text"] == label
