"""What several tests of viewports need."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from rsibr.rsibr_addon.host.visible_surfaces import View


@pytest.fixture
def view() -> "Iterator[View]":
    """Of the factory file's viewport, with a cube."""
    import bpy
    import rsibr
    from rsibr.rsibr_addon.device.context import ensure_context
    from rsibr.rsibr_addon.host.visible_surfaces import View

    bpy.ops.wm.read_factory_settings()
    rsibr.register()
    ensure_context()
    scene, layer = bpy.context.scene, bpy.context.view_layer
    (space,) = (area.spaces.active for area in bpy.context.screen.areas if area.type == "VIEW_3D")
    yield View(scene, (scene.session_uid, layer.name), layer.depsgraph, space)
    rsibr.unregister()
