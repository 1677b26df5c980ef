"""What live light takes from Blender's data."""

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.host.live_light import (
    appearance_of,
    bare,
    is_live_name,
    live_name,
    points_of,
)
from rsibr.rsibr_addon.host.sun_lamps import suns_above
from rsibr.rsibr_addon.host.visible_surfaces import is_wanted, layer_of, map_set_of, renders_surroundings

pytestmark = pytest.mark.usefixtures("registered")


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
    # Harmonics are of mips alone, as kernels have none
    name = map_set_of(cube)
    cube.rsibr.live.degree = 3
    assert map_set_of(cube) == name
    cube.rsibr.live.mips = True
    assert map_set_of(cube) != name
    name = map_set_of(cube)
    cube.rsibr.live.degree = 4
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


def viewport() -> bpy.types.SpaceView3D:
    (space,) = (area.spaces.active for area in bpy.context.screen.areas if area.type == "VIEW_3D")
    return space


@pytest.mark.parametrize("shown", [True, False])
def test_overlays_come_back(shown: bool) -> None:
    space = viewport()
    space.overlay.show_overlays = shown
    with bare(space):
        assert space.overlay.show_overlays is False
    assert space.overlay.show_overlays is shown


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("type", "MATERIAL"),
        ("single_color", (0.1, 0.2, 0.3)),
        ("studiolight_rotate_z", 0.5),
        ("use_scene_world_render", False),
    ],
)
def test_a_viewport_s_settings_make_its_appearance(name: str, value: object) -> None:
    space = viewport()
    before = appearance_of(space)
    assert appearance_of(space) == before
    setattr(space.shading, name, value)
    assert appearance_of(space) != before


def test_one_viewport_renders_an_object_s_surroundings() -> None:
    scene = bpy.context.scene
    cube, layer = bpy.data.objects["Cube"], layer_of(bpy.context)
    other = next(area for area in bpy.context.screen.areas if area.type != "VIEW_3D")
    other.type = "VIEW_3D"
    both = [area.spaces.active for area in bpy.context.screen.areas if area.type == "VIEW_3D"]

    def showing() -> list[bool]:
        return [renders_surroundings(each, cube, {layer}) for each in both]

    assert showing() == [True, False]
    both[0].show_object_viewport_mesh = False
    assert showing() == [False, True]
    both[0].show_object_viewport_mesh = True
    for each in both:
        each.shading.type = "MATERIAL"
        assert sum(showing()) == 1
    both[1].shading.type = "RENDERED"
    assert showing() == [False, True]
    scene.render.engine = "CYCLES"
    assert showing() == [True, False]
    both[0].shading.type = "WIREFRAME"
    assert showing() == [False, False]
    both[0].shading.type = "SOLID"
    assert not renders_surroundings(both[0], cube, {(scene.session_uid, "Another")})


def test_suns_light_what_nothing_hides_from_them() -> None:
    scene, shading = bpy.context.scene, viewport().shading
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    bpy.data.objects["Light"].data.type = "SUN"
    sun = bpy.data.objects["Light"]
    sun.matrix_world = np.eye(4).tolist()
    sun.data.energy, sun.data.color, sun.data.angle = 3.0, (1.0, 0.5, 0.25), 0.02

    def found(distance: float = 0.0) -> tuple[list, list, float]:
        depsgraph = bpy.context.evaluated_depsgraph_get()
        direction, irradiance, angle = suns_above(scene, depsgraph, shading, np.zeros(3), distance)
        return direction.tolist(), irradiance.tolist(), angle

    none = [], [], np.pi
    shading.type = "SOLID"
    assert found() == none
    shading.type = "RENDERED"
    assert found() == ([[0.0, 0.0, 1.0]], [[3.0, 1.5, 0.75]], pytest.approx(0.02))
    sun.data.exposure = 1.0
    assert found()[1] == [[6.0, 3.0, 1.5]]
    bpy.ops.mesh.primitive_plane_add(location=(0.0, 0.0, 2.0))
    assert found() == none
    assert found(distance=2.5)[0] == [[0.0, 0.0, 1.0]]
    bpy.context.object.hide_set(True)
    assert found()[0] == [[0.0, 0.0, 1.0]]
    shading.use_scene_lights_render = False
    assert found() == none
