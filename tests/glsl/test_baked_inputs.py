"""Baked inputs in viewports: shown once they are whole, and until then the old ones."""

from collections.abc import Callable
from pathlib import Path

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.session.material_notes import MaterialNotes
from rsibr.rsibr_addon.settings.baked_inputs import BakedInputsSettings
from rsibr.rsibr_addon.tasks.baked_inputs import bake_inputs
from rsibr.rsibr_addon.tasks.viewport.previews import Previews
from rsibr.tests.glsl.test_own_materials import SIZE, draw, paths, previews, sheet

__all__ = ["draw", "paths", "previews", "sheet"]

pytestmark = pytest.mark.needs("cycles")

Draw = Callable[[], np.ndarray]


def bake(item: bpy.types.Object, path: Path) -> Path:
    drain(bake_inputs(item.name, BakedInputsSettings(size=64, samples=1), path, force=True))
    return path


@pytest.fixture
def half(sheet: bpy.types.Object) -> bpy.types.Node:
    """The node by which the sheet's upper half shines, in both slots."""
    material = bpy.data.materials["first"]
    sheet.data.materials[1] = material
    tree = material.node_tree
    place, part, test = (tree.nodes.new(f"ShaderNode{kind}") for kind in ("TexCoord", "SeparateXYZ", "Math"))
    test.operation, test.inputs[1].default_value = "GREATER_THAN", 0.0
    tree.links.new(place.outputs["Object"], part.inputs[0])
    tree.links.new(part.outputs["Y"], test.inputs[0])
    tree.links.new(test.outputs[0], tree.nodes["Principled BSDF"].inputs["Emission Color"])
    return test


def lit_rows(picture: np.ndarray) -> list[bool]:
    """Which rows shine all over, from below; the two on either side of the middle are not asked."""
    rows = np.r_[0 : SIZE // 2 - 1, SIZE // 2 + 1 : SIZE]
    shining = picture[rows, :, 0] > 0.99
    assert np.all(shining | (picture[rows, :, 0] < 0.01))
    assert np.all(shining == shining[:, :1])
    return shining[:, 0].tolist()


def test_the_bake_that_a_material_needs_is_noted_until_a_preview_tells_of_it(
    sheet: bpy.types.Object, half: bpy.types.Node
) -> None:
    notes = MaterialNotes()
    (note,) = notes.of_object(sheet, is_shown=False)
    assert note.startswith("Material first has a bake in the background for Emission Color")
    assert notes.of_object(sheet, is_shown=True) == []


LOWER = [False] * (SIZE // 2 - 1)
UPPER = [True] * (SIZE // 2 - 1)


@pytest.mark.filterwarnings("ignore:The UV map")
@pytest.mark.parametrize("has_uv_map", [True, False])
def test_a_bake_is_shown_and_stays_until_another_is_there(
    sheet: bpy.types.Object,
    half: bpy.types.Node,
    draw: Draw,
    previews: Previews,
    tmp_path: Path,
    has_uv_map: bool,
) -> None:
    if not has_uv_map:
        sheet.data.uv_layers.remove(sheet.data.uv_layers[0])
    assert previews.materials_of(sheet) is None
    draw()
    assert previews.materials_of(sheet) is not None
    assert previews.inputs.is_unasked
    assert previews.with_baked_inputs() == [sheet]
    (told,) = previews.messages(sheet)
    assert "Until its bake is done, material first shows Blender's default for Emission Color" in told
    first, second = tmp_path / "first.exr", tmp_path / "second.exr"
    assert not previews.inputs.wish(sheet, first)
    assert previews.messages(sheet)[0] == "Materials need a bake: baking."
    assert previews.inputs.wish(sheet, bake(sheet, first))
    assert lit_rows(draw()) == LOWER + UPPER
    assert previews.take_news()  # for the panel, which was drawn before the bake was there
    assert not previews.take_news()
    told = previews.messages(sheet)
    assert len(told) == (not has_uv_map)
    assert all("faces are baked one by one" in each for each in told)

    half.operation = "LESS_THAN"
    previews.scene_changed()
    assert not previews.inputs.wish(sheet, second)
    assert lit_rows(draw()) == LOWER + UPPER
    assert previews.messages(sheet)[0] == "Material changed: baking."
    previews.inputs.ended(second, "It failed.")
    assert previews.messages(sheet)[0] == "It failed."
    assert lit_rows(draw()) == LOWER + UPPER

    previews.inputs.forgive(sheet)
    assert previews.inputs.wish(sheet, bake(sheet, second))
    assert lit_rows(draw()) == UPPER + LOWER
    half.operation = "GREATER_THAN"
    assert previews.inputs.wish(sheet, first)
    assert lit_rows(draw()) == LOWER + UPPER


@pytest.mark.filterwarnings("ignore:The UV map")
def test_faces_that_were_added_are_not_shown_by_the_places_of_others(
    sheet: bpy.types.Object, half: bpy.types.Node, draw: Draw, previews: Previews, tmp_path: Path
) -> None:
    sheet.data.uv_layers.remove(sheet.data.uv_layers[0])
    draw()
    previews.inputs.wish(sheet, bake(sheet, tmp_path / "a.exr"))
    assert lit_rows(draw()) == LOWER + UPPER
    sheet.modifiers.new("Triangulate", "TRIANGULATE")
    previews.scene_changed()
    assert lit_rows(draw()) == UPPER + UPPER  # Blender's default, white
    assert any("this one has other faces" in each for each in previews.messages(sheet))


def test_a_damaged_bake_is_told(
    sheet: bpy.types.Object, half: bpy.types.Node, draw: Draw, previews: Previews, tmp_path: Path
) -> None:
    draw()
    path = bake(sheet, tmp_path / "a.exr")
    path.write_bytes(path.read_bytes()[:-20])
    assert previews.inputs.wish(sheet, path)
    draw()
    assert "truncated or damaged" in previews.messages(sheet)[0]


def test_an_object_that_is_gone_needs_no_bake(
    sheet: bpy.types.Object, half: bpy.types.Node, draw: Draw, previews: Previews
) -> None:
    draw()
    assert previews.with_baked_inputs() == [sheet]
    bpy.data.objects.remove(sheet)
    previews.scene_changed()
    assert previews.with_baked_inputs() == []
