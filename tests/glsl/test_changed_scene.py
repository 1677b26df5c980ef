"""Redraws read Blender's data anew once Blender tells of a change, and only then."""

from collections.abc import Callable, Iterator
from pathlib import Path

import bpy
import gpu
import numpy as np
import pytest
from mathutils import Matrix
from rsibr.rsibr_addon.core.at_once import AtOnce
from rsibr.rsibr_addon.core.conventions import Array
from rsibr.rsibr_addon.files.map_set import write_map_set
from rsibr.rsibr_addon.host.visible_surfaces import View
from rsibr.rsibr_addon.tasks.methods.live_materials import LiveFits
from rsibr.rsibr_addon.tasks.viewport import displays
from rsibr.rsibr_addon.tasks.viewport.displays import Displays
from rsibr.rsibr_addon.tasks.viewport.previews import Previews
from rsibr.tests.faults.small_map_sets import map_sets
from rsibr.tests.glsl.frames import frame_of

SIZE = 16
TO_EYE = Matrix.Rotation(0.5, 4, "X") @ Matrix.Rotation(0.5, 4, "Y")


def cube() -> bpy.types.Object:
    return bpy.data.objects["Cube"]


def node(kind: str) -> bpy.types.Node:
    nodes = bpy.context.scene.world.node_tree.nodes
    return next(each for each in nodes if each.bl_idname == f"ShaderNode{kind}")


def slide() -> None:
    cube().rsibr.mip_chain.k_d = (0.1, 0.1, 0.1)


def brighten() -> None:
    node("Background").inputs["Strength"].default_value = 3.0


def turn() -> None:
    node("Mapping").inputs["Rotation"].default_value.x = 2.0


def expose() -> None:
    bpy.context.scene.view_settings.exposure = 1.0


def transform() -> None:
    bpy.context.scene.view_settings.view_transform = "Standard"


def bend() -> None:
    view = bpy.context.scene.view_settings
    view.use_curve_mapping = True
    view.curve_mapping.curves[3].points[0].location = (0.0, 0.5)
    view.curve_mapping.update()


@pytest.fixture
def previews(view: View, tmp_path: Path) -> Iterator[Previews]:
    """Of a cube in a mip chain of a world that is turned; told of changes as in a window."""
    (chain,) = (each for each in map_sets() if each.kind == "mip_chain")
    write_map_set(tmp_path / "chain.rsibr.exr", chain)
    cube().rsibr.map_set = str(tmp_path / "chain.rsibr.exr")
    tree = view.scene.world.node_tree
    texture, mapping, coordinates = (
        tree.nodes.new(f"ShaderNode{name}") for name in ("TexEnvironment", "Mapping", "TexCoord")
    )
    tree.links.new(texture.outputs[0], node("Background").inputs["Color"])
    tree.links.new(mapping.outputs[0], texture.inputs[0])
    tree.links.new(coordinates.outputs["Generated"], mapping.inputs[0])
    previews = Previews(LiveFits(), AtOnce())

    def changed(*_: object) -> None:
        previews.scene_changed()

    bpy.app.handlers.depsgraph_update_post.append(changed)
    yield previews
    bpy.app.handlers.depsgraph_update_post.remove(changed)


def seen(view: View, previews: Previews) -> Array:
    """A frame, shape (SIZE, SIZE, 4)."""
    bpy.context.view_layer.update()
    target = gpu.types.GPUOffScreen(SIZE, SIZE, format="RGBA32F")
    return frame_of(previews, view, target, TO_EYE)


@pytest.mark.parametrize("change", [slide, brighten, turn, expose, transform, bend])
def test_a_change_shows_in_the_next_redraw(
    view: View, previews: Previews, change: Callable[[], None]
) -> None:
    before = seen(view, previews)
    assert np.array_equal(seen(view, previews), before)
    change()
    after = seen(view, previews)
    assert not np.array_equal(after, before)
    np.testing.assert_array_equal(after, seen(view, Previews(LiveFits(), AtOnce())))


def test_an_object_that_follows_the_world_no_more_shows_at_once(view: View, previews: Previews) -> None:
    before = seen(view, previews)
    brighten()
    seen(view, previews)
    cube().rsibr.follow_world = False
    np.testing.assert_array_equal(seen(view, previews), before)


def test_the_working_space_is_read_once(view: View, monkeypatch: pytest.MonkeyPatch) -> None:
    answers, learnt = [True, False], Displays()
    monkeypatch.setattr(displays, "works_in_rec709", lambda: answers.pop(0))
    assert all(learnt.of_surfaces(view.scene, view.space) for _ in range(3))
    learnt.scene_changed()
    assert learnt.of_surfaces(view.scene, view.space) is None
