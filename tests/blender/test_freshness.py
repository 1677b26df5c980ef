"""Whether objects are up to date: by the name that a bake would have today."""

from collections.abc import Iterator
from pathlib import Path
from unittest.mock import Mock

import bpy
import pytest
import rsibr
from rsibr.operators import keep_fresh
from rsibr.operators.bake_in_background import queue_bake
from rsibr.rsibr_addon.files.map_set import read_map_set_header
from rsibr.rsibr_addon.host import map_sets
from rsibr.rsibr_addon.host.bake_settings import assign
from rsibr.rsibr_addon.host.world_light import follows_world, world_light
from rsibr.rsibr_addon.session.running import session
from rsibr.rsibr_addon.tasks.methods.kinds import own_materials_kind
from rsibr.rsibr_addon.tasks.queue.background import State
from rsibr.rsibr_addon.tasks.queue.bake_request import ObjectBake, output_for, request_for
from rsibr.rsibr_addon.tasks.queue.freshness import Freshness, Stale
from rsibr.rsibr_addon.ui import preview_panel
from rsibr.tests.flat_capture import write_flat_capture


@pytest.fixture(autouse=True)
def _registered(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[None]:
    monkeypatch.setattr("rsibr.rsibr_addon.tasks.queue.bake_request.baked_folder", lambda: tmp_path)
    # As this version would, `flat_capture` says of its files that tests made them
    monkeypatch.setattr("rsibr.rsibr_addon.tasks.queue.freshness.rsibr", lambda: "tests")
    rsibr.register()
    yield
    rsibr.unregister()


def cube() -> bpy.types.Object:
    return bpy.data.objects["Cube"]


def baked(kind: str, light: str, item: bpy.types.Object) -> None:
    """Have an object be shaded from the file of its bake; what that holds does not matter here."""
    scene = bpy.context.scene
    scene.rsibr_bake.kind, scene.rsibr_bake.light = kind, light
    request = request_for(scene.rsibr_bake, scene, item)
    path = output_for(request, scene, item)
    if not path.exists():
        write_flat_capture(path, (0.5, 0.0, 0.5))
    assign([item.session_uid], path, request.shown)


def staleness(item: bpy.types.Object) -> Stale | None:
    freshness = Freshness()
    freshness.look([bpy.context.scene])
    return freshness.stale[item.session_uid]


def painted(level: float) -> bpy.types.Image:
    image = bpy.data.images.new("Sky", 4, 2, float_buffer=True)
    image.pixels[0] = level
    image.pack()
    return image


def environment_texture() -> tuple[bpy.types.Node, bpy.types.Node]:
    """Give the scene's world an Environment Texture with a Mapping, and its Background."""
    tree = bpy.context.scene.world.node_tree
    coordinates, mapping, texture = (
        tree.nodes.new(f"ShaderNode{name}") for name in ("TexCoord", "Mapping", "TexEnvironment")
    )
    tree.links.new(coordinates.outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs["Vector"], texture.inputs["Vector"])
    tree.links.new(texture.outputs["Color"], tree.nodes["Background"].inputs["Color"])
    texture.image = painted(0.0)
    return mapping, tree.nodes["Background"]


@pytest.mark.parametrize(("kind", "by_itself"), [("kernel_pyramid", True), ("mip_chain", True)])
def test_light_of_a_world_is_out_of_date_when_the_world_changes(kind: str, by_itself: bool) -> None:
    baked(kind, "WORLD", cube())
    assert staleness(cube()) is None
    color = bpy.context.scene.world.node_tree.nodes["Background"].inputs["Color"]
    before = tuple(color.default_value)
    color.default_value = (0.9, 0.1, 0.1, 1.0)
    stale = staleness(cube())
    assert stale is not None
    assert (stale.reason, stale.by_itself) == ("World changed", by_itself)
    assert stale.output is not None
    cube().rsibr.follow_world = False
    stale = staleness(cube())
    assert stale is not None
    assert not stale.by_itself
    color.default_value = before
    assert staleness(cube()) is None


def test_an_object_is_served_while_it_is_up_to_date_with_what_is_chosen() -> None:
    scene, chosen, freshness = bpy.context.scene, bpy.context.scene.rsibr_bake, Freshness()

    def served() -> bool:
        freshness.look([scene])
        return freshness.serves(request_for(chosen, scene, cube()), scene, cube())

    assert not served()
    baked("kernel_pyramid", "STUDIO", cube())
    assert served()
    size = chosen.kernel_pyramid.size
    chosen.kernel_pyramid.size = "512" if size != "512" else "256"
    assert not served()
    chosen.kernel_pyramid.size = size
    assert served()
    chosen.light = "WORLD"
    assert not served()
    baked("kernel_pyramid", "WORLD", cube())
    assert served()
    scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 7.0
    assert not served()


def test_materials_are_no_part_of_light() -> None:
    baked("kernel_pyramid", "WORLD", cube())
    cube().active_material.node_tree.nodes["Principled BSDF"].inputs["Metallic"].default_value = 1.0
    assert staleness(cube()) is None


def test_a_world_that_only_turns_and_scales_is_followed_without_a_bake() -> None:
    mapping, background = environment_texture()
    baked("kernel_pyramid", "WORLD", cube())
    mapping.inputs["Rotation"].default_value[2] = 1.0
    background.inputs["Strength"].default_value = 3.0
    assert staleness(cube()) is None
    followed = world_light(bpy.context.scene.world)
    assert followed is not None
    assert follows_world(cube())
    assert followed.strength == 3.0
    bpy.data.images["Sky"].user_remap(painted(1.0))
    stale = staleness(cube())
    assert stale is not None
    assert stale.reason == "World changed"


def test_what_does_not_follow_the_world_holds_its_turn_and_strength() -> None:
    mapping, _ = environment_texture()
    cube().rsibr.follow_world = False
    baked("kernel_pyramid", "WORLD", cube())
    mapping.inputs["Rotation"].default_value[2] = 1.0
    assert staleness(cube()) is not None
    mapping.inputs["Rotation"].default_value[2] = 0.0
    assert staleness(cube()) is None
    cube().rsibr.follow_world = True
    assert staleness(cube()) is not None  # it would be baked bare now
    assert not follows_world(cube())


def test_a_baked_material_is_out_of_date_when_it_changes() -> None:
    baked("radiance_views", "STUDIO", cube())
    material = cube().active_material
    roughness = material.node_tree.nodes["Principled BSDF"].inputs["Roughness"]
    roughness.default_value = 0.125
    stale = staleness(cube())
    assert stale is not None
    assert (stale.reason, stale.by_itself) == ("Material changed", False)
    # The same map set in another object's material
    other = cube().copy()
    bpy.context.collection.objects.link(other)
    other.data = other.data.copy()
    roughness.default_value = 0.5
    other.data.materials[0] = bpy.data.materials.new("Other")
    freshness = Freshness()
    freshness.look([bpy.context.scene])
    assert freshness.of(cube()) is None
    assert [items for _, items in freshness.wanted(bpy.context.scene)] == [[other]]


def test_a_file_of_another_version_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    baked("kernel_pyramid", "WORLD", cube())
    monkeypatch.setattr("rsibr.rsibr_addon.host.version.software", lambda: "rsibr 9")
    monkeypatch.setattr("rsibr.rsibr_addon.tasks.queue.freshness.rsibr", lambda: "rsibr 9")
    stale = staleness(cube())
    assert stale is not None
    assert (stale.reason, stale.by_itself) == ("Baked by another version", False)


def test_what_cannot_be_baked_any_more_says_why() -> None:
    baked("radiance_views", "STUDIO", cube())
    cube().data.materials.clear()
    stale = staleness(cube())
    assert stale is not None
    assert stale.output is None
    assert "Cube has no material" in stale.reason


def test_another_world_and_another_file_are_noticed() -> None:
    scene, freshness = bpy.context.scene, Freshness()
    baked("kernel_pyramid", "WORLD", cube())
    assert freshness.has_changed(scene, [])
    freshness.look([scene])
    assert not freshness.has_changed(scene, [cube()])
    scene.world = bpy.data.worlds.new("Night")
    assert freshness.has_changed(scene, [])
    freshness.look([scene])
    cube().rsibr.follow_world = False
    assert freshness.has_changed(scene, [cube()])
    freshness.look([scene])
    cube().rsibr.map_set = ""
    assert not freshness.has_changed(scene, [cube()])


def test_rebake_makes_all_that_is_out_of_date(monkeypatch: pytest.MonkeyPatch) -> None:
    made = []
    monkeypatch.setattr(
        "rsibr.operators.rebake.queue_bake", lambda scene, request, items: made.append(items) or "Baking"
    )
    baked("mip_chain", "WORLD", cube())
    other = cube().copy()
    bpy.context.collection.objects.link(other)
    assert bpy.ops.rsibr.rebake() == {"FINISHED"}
    assert made == []
    bpy.context.scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0.5
    assert bpy.ops.rsibr.rebake() == {"FINISHED"}
    assert made == [[cube(), other]]


def test_rebake_tells_what_cannot_be_baked(capfd: pytest.CaptureFixture[str]) -> None:
    baked("radiance_views", "STUDIO", cube())
    cube().data.materials.clear()
    bpy.ops.rsibr.rebake()
    told = capfd.readouterr().out
    assert "Warning: Not all can be baked anew. Object Cube has no material" in told
    assert "up to date" not in told


@pytest.mark.parametrize(
    ("state", "is_bad"), [(State.DONE, False), (State.FAILED, True), (State.CANCELLED, True)]
)
def test_what_was_undone_is_baked_again_by_itself_but_not_what_failed(
    state: State, is_bad: bool, tmp_path: Path
) -> None:
    output = tmp_path / "a.rsibr.exr"
    session().bakes.bakes.append(ObjectBake("a", output, (), state=state))
    assert keep_fresh._has_ended_badly(output) == is_bad


def test_a_bake_that_the_artist_asks_for_meanwhile_is_no_more_by_itself() -> None:
    scene = bpy.context.scene
    scene.rsibr_bake.kind, scene.rsibr_bake.light = "mip_chain", "WORLD"
    request = request_for(scene.rsibr_bake, scene, cube())
    going_on = ObjectBake("a", output_for(request, scene, cube()), ("sleep", "60"), by_itself=True)
    session().bakes.bakes.append(going_on)
    queue_bake(scene, request, [cube()], by_itself=True)
    assert going_on.by_itself
    queue_bake(scene, request, [cube()])
    assert not going_on.by_itself
    assert going_on.items == [cube().session_uid]


def test_a_bake_that_nobody_asked_for_leaves_alone_what_wants_it_no_more(tmp_path: Path) -> None:
    path = tmp_path / "a.rsibr.exr"
    by_itself = ObjectBake("a", path, (), items=[1, 2], by_itself=True)
    asked = ObjectBake("b", path, (), items=[1, 2])
    session().bakes.bakes += [by_itself, asked]
    keep_fresh._cancel_all_but({(path, 2), (tmp_path / "another", 1)})
    assert (by_itself.items, by_itself.ended) == ([2], False)
    keep_fresh._cancel_all_but({(tmp_path / "another", 1)})
    assert by_itself.state is State.CANCELLED
    assert (asked.items, asked.ended) == ([1, 2], False)


def test_a_map_set_is_read_once_for_all_objects_of_a_scene(monkeypatch: pytest.MonkeyPatch) -> None:
    scene, read = bpy.context.scene, []
    kind = own_materials_kind()
    request = request_for(scene.rsibr_bake, scene, cube(), kind)
    write_flat_capture(output_for(request, scene, cube()), (0.5, 0.0, 0.5))
    for _ in range(5):
        scene.collection.objects.link(cube().copy())
    monkeypatch.setattr(
        map_sets, "read_map_set_header", lambda path: read.append(path) or read_map_set_header(path)
    )
    assert bpy.ops.rsibr.preview_scene() == {"FINISHED"}
    shaded = [each for each in scene.objects if each.rsibr.map_set]
    assert len(shaded) == 6
    assert all(each.rsibr.content and each.rsibr_baked.kind == kind for each in shaded)
    assert len(read) == 1


@pytest.mark.parametrize(
    ("served", "told"), [(True, "Up to date"), (False, "The map set shown is up to date")]
)
def test_the_panel_says_what_is_up_to_date_where_another_map_set_would_be_baked(
    served: bool, told: str
) -> None:
    baked("mip_chain", "STUDIO", cube())
    session().freshness.look([bpy.context.scene])
    if not served:
        bpy.context.scene.rsibr_bake.kind = "reflection_tables"
    said = drawn_request_and_state()
    estimates = [text for icon, text in said if icon == "TIME"]
    assert bool(estimates) == (not served)
    assert [text for icon, text in said if icon == "CHECKMARK"] == [told]


def drawn_request_and_state() -> list[tuple[str, str]]:
    """Icons and texts that the panel *Preview* shows below its buttons."""
    layout = Mock()
    layout.column.return_value = layout
    context = Mock(scene=bpy.context.scene, object=cube())
    context.region.width = 10_000  # each sentence in one line
    served = preview_panel._draw_request(layout, context)
    preview_panel._draw_freshness(layout, cube(), context.region.width, served)
    return [(each.kwargs.get("icon", ""), each.kwargs["text"]) for each in layout.label.call_args_list]
