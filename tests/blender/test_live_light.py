"""What live light takes from Blender's data."""

from collections.abc import Iterator

import bpy
import numpy as np
import pytest
import rsibr
from rsibr.rsibr_addon.host.live_light import bare, is_live_name, live_name, points_of
from rsibr.rsibr_addon.host.viewport import is_wanted, map_set_of


@pytest.fixture(autouse=True)
def _registered() -> Iterator[None]:
    rsibr.register()
    yield
    rsibr.unregister()


def test_live_light_comes_before_a_map_set() -> None:
    cube = bpy.data.objects["Cube"]
    assert not is_wanted()
    cube.rsibr.live.on = True
    assert is_wanted()
    cube.rsibr.map_set = "/tmp/some.rsibr.exr"
    name = map_set_of(cube)
    assert name == live_name(cube)
    assert is_live_name(name)
    assert "64" in name
    cube.rsibr.live.size = "128"
    assert map_set_of(cube) != name
    assert live_name(bpy.data.objects["Camera"]) != live_name(cube)
    cube.rsibr.show = False
    assert map_set_of(cube) == ""
    cube.rsibr.show, cube.rsibr.live.on = True, False
    assert map_set_of(cube) == "/tmp/some.rsibr.exr"
    assert not is_live_name(map_set_of(cube))


def test_points_are_the_evaluated_mesh_s_or_a_box() -> None:
    cube = bpy.data.objects["Cube"]
    cube.modifiers.new("Subdivision", "SUBSURF").levels = 2
    bpy.ops.object.text_add()
    text = bpy.context.object
    depsgraph = bpy.context.evaluated_depsgraph_get()
    points = points_of(cube, depsgraph)
    # A cube's faces, divided twice: 6 * 16 + 2 vertices, all drawn in.
    assert points.shape == (98, 3)
    assert 0.5 < np.abs(points).max() < 1.0
    np.testing.assert_array_equal(points_of(text, depsgraph), np.array(text.bound_box))


@pytest.mark.parametrize("shown", [True, False])
def test_overlays_come_back(shown: bool) -> None:
    (space,) = (area.spaces.active for area in bpy.context.screen.areas if area.type == "VIEW_3D")
    space.overlay.show_overlays = shown
    with bare(space):
        assert space.overlay.show_overlays is False
    assert space.overlay.show_overlays is shown
