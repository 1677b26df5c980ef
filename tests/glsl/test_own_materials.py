"""Objects drawn with their own materials, slot by slot: what an artist changes shows in the next frame."""

from collections.abc import Callable
from pathlib import Path

import bpy
import gpu
import numpy as np
import pytest
from mathutils import Matrix
from rsibr.rsibr_addon.core.at_once import AtOnce
from rsibr.rsibr_addon.device.kinds.kernel_pyramid import GpuPyramid
from rsibr.rsibr_addon.files.map_set import write_map_set
from rsibr.rsibr_addon.host.map_sets import use_map_set
from rsibr.rsibr_addon.host.visible_surfaces import View
from rsibr.rsibr_addon.host.world_light import WorldLight
from rsibr.rsibr_addon.tasks.methods.live_materials import LiveFits
from rsibr.rsibr_addon.tasks.viewport import own_materials
from rsibr.rsibr_addon.tasks.viewport.contents import Contents
from rsibr.rsibr_addon.tasks.viewport.previews import Previews
from rsibr.tests.faults.small_map_sets import map_sets

SIZE = 16
RED, GREEN, BLUE = (0.75, 0.0, 0.0), (0.0, 0.5, 0.0), (0.0, 0.0, 0.25)

Draw = Callable[[], np.ndarray]


@pytest.fixture
def paths(tmp_path: Path) -> dict[str, str]:
    """Kind -> a map set of it."""
    there = {}
    for map_set in map_sets():
        if map_set.kind in ("kernel_pyramid", "lobe_stack"):
            there[map_set.kind] = str(tmp_path / f"{map_set.kind}.rsibr.exr")
            write_map_set(Path(there[map_set.kind]), map_set)
    return there


@pytest.fixture
def previews() -> Previews:
    return Previews(LiveFits(), AtOnce())


@pytest.fixture
def draw(view: View, previews: Previews) -> Draw:
    """Draw a frame of x and y from -2 to 2, seen from above, and read it, shape (SIZE, SIZE, 4)."""
    target = gpu.types.GPUOffScreen(SIZE, SIZE, format="RGBA32F")
    view.scene.view_settings.view_transform = "Standard"

    def frame() -> np.ndarray:
        bpy.context.view_layer.update()
        with target.bind(), gpu.matrix.push_pop(), gpu.matrix.push_pop_projection():
            framebuffer = gpu.state.active_framebuffer_get()
            framebuffer.clear(color=(0.0, 0.0, 0.0, 0.0), depth=1.0)
            gpu.matrix.load_matrix(Matrix.Identity(4))
            gpu.matrix.load_projection_matrix(Matrix.Diagonal((0.5, 0.5, -0.02, 1.0)))
            with previews.faults.guarded():
                if not previews.draw(view):
                    previews.add_display(view.scene)
                    previews.draw(view)
            read = framebuffer.read_color(0, 0, SIZE, SIZE, 4, 0, "FLOAT")
        assert previews.faults.trouble is None
        for each in bpy.data.objects:
            assert previews.faults.message(each) is None
        return np.array(read.to_list())

    return frame


def emitter(name: str, color: tuple[float, float, float]) -> bpy.types.Material:
    """A material that shines, and reflects nothing: its light is its colour."""
    material = bpy.data.materials.new(name)
    inputs = material.node_tree.nodes["Principled BSDF"].inputs
    inputs["Base Color"].default_value = (0.0, 0.0, 0.0, 1.0)
    inputs["Specular IOR Level"].default_value = 0.0
    inputs["Emission Strength"].default_value = 1.0
    inputs["Emission Color"].default_value = (*color, 1.0)
    return material


def set_color(material: bpy.types.Material, color: tuple[float, float, float]) -> None:
    material.node_tree.nodes["Principled BSDF"].inputs["Emission Color"].default_value = (*color, 1.0)


def textured(material: bpy.types.Material, uv_map: str = "") -> bpy.types.Image:
    """Have a material shine as an image, whose left half is red and right half green."""
    image = bpy.data.images.new("picture", 4, 4, float_buffer=True)
    row = np.repeat(np.array([(*RED, 1.0), (*GREEN, 1.0)], np.float32), 2, axis=0)
    image.pixels.foreach_set(np.tile(row, (4, 1)).ravel())
    tree = material.node_tree
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image, node.interpolation = image, "Closest"
    tree.links.new(node.outputs["Color"], tree.nodes["Principled BSDF"].inputs["Emission Color"])
    if uv_map:
        lookup = tree.nodes.new("ShaderNodeUVMap")
        lookup.uv_map = uv_map
        tree.links.new(lookup.outputs[0], node.inputs["Vector"])
    return image


@pytest.fixture
def sheet(view: View, paths: dict[str, str]) -> bpy.types.Object:
    """Two squares that fill the frame: the left one of the first slot, the right one of the second."""
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    mesh = bpy.data.meshes.new("sheet")
    places = [(x, y, 0.0) for y in (-2, 2) for x in (-2, 0, 2)]
    mesh.from_pydata(places, [], [(0, 1, 4, 3), (1, 2, 5, 4)])
    vertices = [0, 1, 4, 3, 1, 2, 5, 4]
    uv = [(places[vertex][0] / 4 + 0.5, places[vertex][1] / 4 + 0.5) for vertex in vertices]
    mesh.uv_layers.new(name="UVMap").uv.foreach_set("vector", np.ravel(uv).astype(np.float32))
    for material in (emitter("first", RED), emitter("second", GREEN)):
        mesh.materials.append(material)
    mesh.polygons[1].material_index = 1
    item = bpy.data.objects.new("sheet", mesh)
    view.scene.collection.objects.link(item)
    item.rsibr.show = True
    use_map_set(item.rsibr, paths["kernel_pyramid"])
    return item


def check(picture: np.ndarray, left: tuple[float, float, float], right: tuple[float, float, float]) -> None:
    """Whether both halves have a colour each; the display's table of colours is interpolated."""
    half = SIZE // 2
    for seen, color in ((picture[:, 1 : half - 1], left), (picture[:, half + 1 : -1], right)):
        np.testing.assert_allclose(seen[..., :3], np.broadcast_to(color, seen[..., :3].shape), atol=0.01)


def test_each_slot_has_its_own_material(sheet: bpy.types.Object, draw: Draw) -> None:
    check(draw(), RED, GREEN)


def test_a_slider_shows_in_the_next_frame(sheet: bpy.types.Object, draw: Draw, previews: Previews) -> None:
    draw()
    set_color(bpy.data.materials["second"], BLUE)
    previews.scene_changed()
    check(draw(), RED, BLUE)


@pytest.mark.slow
def test_an_image_shows_and_its_pixels_as_they_are_painted(
    sheet: bpy.types.Object, draw: Draw, previews: Previews
) -> None:
    draw()
    image = textured(bpy.data.materials["first"])
    sheet.data.materials[1] = bpy.data.materials["first"]
    previews.scene_changed()
    check(draw(), RED, GREEN)
    image.pixels.foreach_set(np.tile(np.array([*BLUE, 1.0], np.float32), 16))
    check(draw(), BLUE, BLUE)  # of which Blender sends no notice
    bpy.data.images.remove(image)
    previews.scene_changed()
    check(draw(), (1.0, 0.0, 1.0), (1.0, 0.0, 1.0))


def test_slots_come_and_go_and_faces_change_theirs(
    sheet: bpy.types.Object, draw: Draw, previews: Previews
) -> None:
    draw()
    sheet.data.materials.append(emitter("third", BLUE))
    sheet.data.polygons[0].material_index = 2
    sheet.data.update()
    previews.scene_changed()
    check(draw(), BLUE, GREEN)
    bpy.data.materials.remove(bpy.data.materials["third"])
    sheet.data.polygons[1].material_index = 7  # beyond the last slot, which is empty now
    sheet.data.update()
    previews.scene_changed()
    picture = draw()
    np.testing.assert_array_equal(picture[:, 2], picture[:, -2])
    sheet.data.materials.pop()
    previews.scene_changed()
    check(draw(), GREEN, GREEN)


@pytest.mark.slow
def test_a_uv_map_that_is_renamed_is_missed_and_said_to_be(
    sheet: bpy.types.Object, draw: Draw, previews: Previews
) -> None:
    textured(bpy.data.materials["first"], "UVMap")
    sheet.data.materials[1] = bpy.data.materials["first"]
    check(draw(), RED, GREEN)
    assert previews.messages(sheet) == []
    sheet.data.uv_layers[0].name = "renamed"
    previews.scene_changed()
    check(draw(), RED, RED)  # the lower left corner's
    assert previews.messages(sheet) == [
        "sheet does not have the UV map UVMap, which material first asks for: add one."
    ]


def test_after_an_undo_the_materials_are_those_that_are_there(
    sheet: bpy.types.Object, draw: Draw, previews: Previews
) -> None:
    draw()
    sheet.data.materials[0] = bpy.data.materials["second"]
    bpy.data.materials.remove(bpy.data.materials["first"])
    previews.data_replaced()
    check(draw(), GREEN, GREEN)


def test_sliders_stand_in_for_the_other_look_and_for_another_kind(
    sheet: bpy.types.Object, draw: Draw, previews: Previews, paths: dict[str, str]
) -> None:
    settings = bpy.context.window_manager.rsibr_view
    settings.split, settings.beyond, settings.line = True, "other", 0.5
    sheet.rsibr.other.kernel_pyramid.own = False
    other = draw()[:, SIZE // 2 + 1 : -1]
    check(np.concatenate([draw()[:, : SIZE // 2]] * 2, axis=1), RED, RED)
    assert other[..., 0].min() > 0.0  # lit, where its own material would be green alone
    settings.split = False
    use_map_set(sheet.rsibr, paths["lobe_stack"])
    previews.scene_changed()
    lit = draw()
    assert lit[..., :3].min() > 0.0
    use_map_set(sheet.rsibr, paths["kernel_pyramid"])
    previews.scene_changed()
    check(draw(), RED, GREEN)
    sheet.rsibr.kernel_pyramid.own = False
    previews.scene_changed()
    np.testing.assert_allclose(draw()[:, SIZE // 2 + 1 : -1], other, atol=1e-6)


def test_an_instance_has_the_materials_of_its_object(
    sheet: bpy.types.Object, draw: Draw, view: View, previews: Previews
) -> None:
    group = bpy.data.collections.new("group")
    group.objects.link(sheet)
    view.scene.collection.objects.unlink(sheet)
    instance = bpy.data.objects.new("instance", None)
    instance.instance_type, instance.instance_collection = "COLLECTION", group
    instance.scale.x = -1.0
    view.scene.collection.objects.link(instance)
    previews.scene_changed()
    check(draw(), GREEN, RED)


def test_edit_mode_shows_the_materials_of_what_is_edited(
    sheet: bpy.types.Object, draw: Draw, view: View
) -> None:
    textured(bpy.data.materials["first"], "UVMap")
    sheet.data.materials[1] = bpy.data.materials["first"]
    bpy.context.view_layer.objects.active = sheet
    bpy.ops.object.mode_set(mode="EDIT")
    check(draw(), RED, GREEN)


def test_what_is_no_mesh_has_its_materials_too(
    sheet: bpy.types.Object, draw: Draw, view: View, previews: Previews, paths: dict[str, str]
) -> None:
    bpy.data.objects.remove(sheet)
    curve = bpy.data.curves.new("filled", "CURVE")
    curve.dimensions, curve.fill_mode = "2D", "BOTH"
    line = curve.splines.new("POLY")
    line.points.add(3)
    for point, (x, y) in zip(line.points, ((-2, -2), (2, -2), (2, 2), (-2, 2)), strict=True):
        point.co = (x, y, 0.0, 1.0)
    line.use_cyclic_u = True
    curve.materials.append(bpy.data.materials["second"])
    item = bpy.data.objects.new("filled", curve)
    view.scene.collection.objects.link(item)
    item.rsibr.show = True
    use_map_set(item.rsibr, paths["kernel_pyramid"])
    previews.scene_changed()
    check(draw(), GREEN, GREEN)


def test_geometry_that_nodes_make_has_the_materials_that_they_set(
    sheet: bpy.types.Object, draw: Draw, previews: Previews
) -> None:
    tree = bpy.data.node_groups.new("grid", "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    grid, end = tree.nodes.new("GeometryNodeMeshGrid"), tree.nodes.new("NodeGroupOutput")
    setting, instances = (
        tree.nodes.new(f"GeometryNode{name}") for name in ("SetMaterial", "GeometryToInstance")
    )
    grid.inputs["Size X"].default_value = grid.inputs["Size Y"].default_value = 4.0
    setting.inputs["Material"].default_value = emitter("third", BLUE)
    tree.links.new(grid.outputs[0], setting.inputs[0])
    tree.links.new(setting.outputs[0], instances.inputs[0])
    tree.links.new(setting.outputs[0], end.inputs[0])
    sheet.modifiers.new("grid", "NODES").node_group = tree
    previews.scene_changed()
    check(draw(), BLUE, BLUE)
    tree.links.new(instances.outputs[0], end.inputs[0])
    previews.scene_changed()
    check(draw(), BLUE, BLUE)


def test_what_is_in_front_hides_what_has_another_strength_of_light(
    sheet: bpy.types.Object, draw: Draw, view: View, previews: Previews, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Previews of each strength are drawn by themselves, and those of others as what hides them."""
    above = sheet.copy()
    above.data = sheet.data.copy()
    for slot, name in enumerate(("second", "first")):
        above.data.materials[slot] = bpy.data.materials[name]
    above.location.z = 1.0
    view.scene.collection.objects.link(above)
    space = view.space
    space.shading.type, space.overlay.show_overlays = "MATERIAL", False  # Blender leaves no depths
    strengths = {"sheet": 1.0, above.name: 2.0}
    monkeypatch.setattr(
        Contents, "light_of", lambda _, surface: WorldLight(strengths[surface.item.name], np.eye(3))
    )
    check(draw(), GREEN, RED)
    above.location.z = -1.0
    previews.scene_changed()
    check(draw(), RED, GREEN)


def test_what_is_emitted_shows_in_a_world_without_light(
    sheet: bpy.types.Object, draw: Draw, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Contents, "light_of", lambda *_: WorldLight(0.0, np.eye(3)))
    check(draw(), RED, GREEN)


def test_steady_frames_and_moved_objects_read_no_material(
    sheet: bpy.types.Object, draw: Draw, previews: Previews, monkeypatch: pytest.MonkeyPatch
) -> None:
    draw()

    def refuse(_: bpy.types.Material) -> None:
        pytest.fail("a material was read")

    monkeypatch.setattr(own_materials, "shown_material", refuse)
    check(draw(), RED, GREEN)
    sheet.location.z = 0.5
    previews.scene_changed(materials=False)
    check(draw(), RED, GREEN)


def test_an_object_without_faces_is_nothing(sheet: bpy.types.Object, draw: Draw, previews: Previews) -> None:
    draw()
    sheet.data.clear_geometry()
    previews.scene_changed()
    assert not draw().any()


def test_the_look_says_whether_materials_are_antialiased(
    sheet: bpy.types.Object, draw: Draw, previews: Previews, monkeypatch: pytest.MonkeyPatch
) -> None:
    draw()
    drawn: list[bool] = []
    monkeypatch.setattr(GpuPyramid, "draw", lambda *given: drawn.append(given[-1].antialiased))
    for antialiased in (True, False):
        sheet.rsibr.kernel_pyramid.antialiased = antialiased
        previews.scene_changed(materials=False)
        draw()
    assert drawn == [True, False]
