"""The temporary scene: whatever happens in it, the artist's file is as it was."""

import bpy
import pytest
from rsibr.rsibr_addon.host.materials import load_material
from rsibr.rsibr_addon.host.scenes import temporary_scene
from rsibr.rsibr_addon.host.spheres import add_sphere
from rsibr.tests.open_file import open_file_state


def fill(scene: bpy.types.Scene) -> None:
    """Add to a scene what captures and comparisons add."""
    add_sphere(scene, load_material("copper"))
    scene.world = bpy.data.worlds.new("ours")
    scene.compositing_node_group = bpy.data.node_groups.new("ours", "CompositorNodeTree")
    bpy.data.images.new("ours", 4, 4, float_buffer=True)
    bpy.data.meshes.new("orphan")
    scene.frame_set(7)
    scene.render.resolution_x = 11


def test_nothing_remains() -> None:
    before = open_file_state()
    with temporary_scene() as scene:
        fill(scene)
        assert open_file_state()["datablocks"] != before["datablocks"]
    assert open_file_state() == before


def test_nothing_remains_after_an_error() -> None:
    def fail() -> None:
        with temporary_scene() as scene:
            fill(scene)
            raise ZeroDivisionError

    before = open_file_state()
    with pytest.raises(ZeroDivisionError):
        fail()
    assert open_file_state() == before


def test_an_inner_scene_leaves_the_outer_one() -> None:
    with temporary_scene() as outer:
        fill(outer)
        before = open_file_state()
        with temporary_scene() as inner:
            assert inner.name != outer.name
            fill(inner)
        assert open_file_state() == before


def test_the_artists_data_can_be_used_and_stays() -> None:
    material, world = bpy.data.materials["Material"], bpy.data.worlds["World"]
    before = open_file_state()
    with temporary_scene() as scene:
        add_sphere(scene, material)
        scene.world = world
    assert open_file_state() == before


def test_names_may_be_taken() -> None:
    bpy.data.scenes.new("RSIBR")
    bpy.data.materials.new("copper")
    before = open_file_state()
    with temporary_scene() as scene:
        fill(scene)
    assert open_file_state() == before


@pytest.mark.needs("cycles")
def test_an_artists_handlers_rest_and_return() -> None:
    called = []

    def handler(*_: object) -> None:
        called.append(1)

    kinds = ("render_pre", "render_post", "render_complete", "frame_change_pre", "depsgraph_update_post")
    for kind in kinds:
        getattr(bpy.app.handlers, kind).append(handler)
    before = open_file_state()
    with temporary_scene() as scene:
        scene.camera = bpy.data.objects["Camera"]
        scene.render.engine, scene.cycles.samples = "CYCLES", 1
        scene.render.resolution_x = scene.render.resolution_y = 4
        bpy.ops.render.render(scene=scene.name)
    assert called == []
    assert open_file_state() == before
    bpy.context.scene.frame_set(3)
    assert called


def test_a_scene_of_ours_is_at_the_artists_frame() -> None:
    bpy.context.scene.frame_set(7, subframe=0.5)
    with temporary_scene() as scene:
        assert scene.frame_current_final == 7.5
