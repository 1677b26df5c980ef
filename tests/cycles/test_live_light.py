"""Live light sees what stands within an object's bounding box, as Cycles sees it without the object."""

from collections.abc import Iterator

import bpy
import numpy as np
import pytest
import rsibr
from rsibr.rsibr_addon.device.context import ensure_context
from rsibr.rsibr_addon.device.kinds.live_environment import GpuLiveEnvironment
from rsibr.rsibr_addon.host.live_light import hidden
from rsibr.rsibr_addon.host.surroundings import (
    Sampling,
    render_surroundings,
    surroundings_of,
    surroundings_scene,
)
from rsibr.rsibr_addon.host.visible_surfaces import Surface, View, surfaces
from rsibr.rsibr_addon.tasks.viewport.live_light import LiveLight

SIZE = 16

RED, GREEN, BLUE, WHITE = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (1.0, 1.0, 1.0)


@pytest.fixture
def view() -> Iterator[View]:
    """A viewport that shows flat colours, in an empty scene."""
    bpy.ops.wm.read_factory_settings()
    for item in list(bpy.data.objects):
        bpy.data.objects.remove(item)
    rsibr.register()
    ensure_context()
    area = next(area for area in bpy.context.screen.areas if area.type == "VIEW_3D")
    space = area.spaces.active
    space.shading.type, space.shading.light, space.shading.color_type = "SOLID", "FLAT", "OBJECT"
    space.shading.background_type, space.shading.background_color = "VIEWPORT", (0.0, 0.0, 0.0)
    space.shading.show_object_outline = False
    bpy.context.preferences.system.viewport_aa = "OFF"
    bpy.context.scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0.0
    scene, layer = bpy.context.scene, bpy.context.view_layer
    region = next(region for region in area.regions if region.type == "WINDOW")
    with bpy.context.temp_override(area=area, region=region):
        yield View(scene, (scene.session_uid, layer.name), layer.depsgraph, space)
    rsibr.unregister()


def coloured(colour: tuple[float, float, float]) -> bpy.types.Object:
    """The active object, in a colour that shines as brightly in Cycles."""
    item, material = bpy.context.object, bpy.data.materials.new("shining")
    nodes = material.node_tree.nodes
    shining = nodes.new("ShaderNodeEmission")
    shining.inputs["Color"].default_value = item.color = (*colour, 1.0)
    output = next(node for node in nodes if node.type == "OUTPUT_MATERIAL")
    material.node_tree.links.new(shining.outputs[0], output.inputs["Surface"])
    item.data.materials.append(material)
    return item


def surface_of(view: View, item: bpy.types.Object) -> Surface:
    return next(surface for surface, _ in surfaces(view.depsgraph) if surface.item == item)


def live_faces(view: View, item: bpy.types.Object) -> np.ndarray:
    """Shape (6, SIZE, SIZE, 3), rows from the bottom up."""
    view.depsgraph.update()
    light = LiveLight(GpuLiveEnvironment(SIZE))
    while not light.is_ready:
        assert light.render(view, surface_of(view, item))
    strip = np.array(light.gpu_map_set._faces.texture.read(), np.float32)
    return strip.reshape(SIZE, 6, SIZE, 4)[..., :3].swapaxes(0, 1)


def cycles_faces(item: bpy.types.Object) -> np.ndarray:
    around = surroundings_of(None, item.name, None, None)
    with surroundings_scene(around) as scene:
        seen = [
            render_surroundings(scene, around, face, (SIZE, SIZE), Sampling(0, 16, 16, 0))["radiance"]
            for face in range(6)
        ]
    return np.stack(seen)


def test_what_stands_within_the_bounding_box_is_seen_and_the_object_is_not(view: View) -> None:
    bpy.ops.mesh.primitive_torus_add(
        location=(1.0, 2.0, 3.0), major_radius=2.0, minor_radius=0.5, major_segments=16, minor_segments=8
    )
    ring = coloured(RED)
    # Beneath the hole and above the ring's lowest point; beside it, half within; the floor that it lies on
    bpy.ops.mesh.primitive_plane_add(location=(1.2, 2.0, 2.7), size=0.4)
    coloured(GREEN)
    bpy.ops.mesh.primitive_cube_add(location=(2.0, 3.0, 3.1), size=0.3)
    coloured(BLUE)
    bpy.ops.mesh.primitive_plane_add(location=(1.0, 2.0, 2.5), size=20.0)
    coloured(WHITE)
    ring.select_set(True)
    seen, expected = live_faces(view, ring), cycles_faces(ring)
    assert ring.select_get()
    assert not ring.hide_get()
    for colour in (GREEN, BLUE, WHITE):
        assert np.any(np.all(expected == colour, axis=-1))
    # A texel on a border is of one colour here, and a mean there
    whole = np.all((expected == 0.0) | (expected == 1.0), axis=-1)
    assert whole.mean() > 0.8
    np.testing.assert_allclose(seen[whole], expected[whole], atol=2e-3)
    assert not np.any(np.all(seen == RED, axis=-1))


def test_an_instance_is_cut_off_alone(view: View) -> None:
    """Without the other instances that the same object makes, which hiding would take away."""
    bpy.ops.mesh.primitive_cube_add()
    cube = coloured(RED)
    group = bpy.data.collections.new("Group")
    _move(cube, group)
    bpy.ops.mesh.primitive_plane_add(location=(0.0, 0.0, -1.0), size=20.0)
    floor = coloured(WHITE)
    _move(floor, group)
    bpy.ops.object.collection_instance_add(collection="Group", location=(5.0, 0.0, 0.0))
    seen = live_faces(view, cube)
    assert np.any(np.all(seen == WHITE, axis=-1))
    assert not np.any(np.all(seen == RED, axis=-1))


def test_what_a_background_scene_lends_is_cut_off(view: View) -> None:
    """It is in none of the view layer's collections, and cannot be hidden there."""
    stage = bpy.data.scenes.new("Stage")
    bpy.ops.mesh.primitive_cube_add()
    cube = coloured(RED)
    _move(cube, stage.collection)
    bpy.ops.mesh.primitive_plane_add(location=(0.0, 0.0, -1.0), size=20.0)
    _move(coloured(WHITE), stage.collection)
    view.scene.background_set = stage
    seen = live_faces(view, cube)
    assert np.any(np.all(seen == WHITE, axis=-1))
    assert not np.any(np.all(seen == RED, axis=-1))


def test_other_windows_hear_of_it_while_it_is_hidden(view: View) -> None:
    """Else they tell of a change later, for which all light is rendered anew, and so on for ever."""
    bpy.ops.mesh.primitive_cube_add()
    cube, layer = bpy.context.object, bpy.context.view_layer
    other = bpy.context.window.view_layer = view.scene.view_layers.new("Other")
    told: list[str] = []

    def changed(_: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
        told.append(depsgraph.view_layer.name)

    layer.update()
    other.update()
    bpy.app.handlers.depsgraph_update_post.append(changed)
    with hidden(cube, layer):
        pass
    assert "Other" in told
    told.clear()
    layer.update()
    other.update()
    bpy.app.handlers.depsgraph_update_post.remove(changed)
    assert not told


def _move(item: bpy.types.Object, collection: bpy.types.Collection) -> None:
    item.users_collection[0].objects.unlink(item)
    collection.objects.link(item)
