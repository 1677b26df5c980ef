"""What panels tell of Blender's own shading, and which panels they name."""

import bpy
import pytest
from rsibr.rsibr_addon.settings.kernel_bank import KernelBankSettings
from rsibr.rsibr_addon.settings.mip_chain import MipChainSettings
from rsibr.rsibr_addon.ui import look_panel
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


def test_hints_name_panels_by_their_labels() -> None:
    look = f"in {look_panel.RSIBR_PT_look.bl_label}."
    assert MipChainSettings.REMARK.endswith(look)
    assert KernelBankSettings.REMARK.endswith(look)
