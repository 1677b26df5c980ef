"""Procedural materials in Blender's window: baked in the background after edits, and shown from then on."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance

Told = Callable[[str], dict]


@pytest.fixture(autouse=True)
def _pyramid(job: Path) -> None:
    light = str(job / "white.exr")
    write_radiance(Path(light), np.ones((32, 64, 3), np.float32), force=True)
    output = str(job / "pyramid.rsibr.exr")
    assert run(["bake", "kernel-pyramid", "--environment", light, "--force", "-o", output]) == 0


PRELUDE = """
def glowing(cube):
    # A cube whose right half glows, by a coordinate that no image says
    bare(view())
    view().spaces.active.region_3d.view_rotation = (0.7071068, 0.7071068, 0.0, 0.0)  # from the front
    bpy.context.scene.view_settings.view_transform = "Standard"
    material = cube.active_material
    tree = material.node_tree
    bsdf = tree.nodes["Principled BSDF"]
    bsdf.inputs["Base Color"].default_value = (0, 0, 0, 1)
    bsdf.inputs["Specular IOR Level"].default_value = 0.0
    bsdf.inputs["Emission Strength"].default_value = 1.0
    place, part, test = (tree.nodes.new("ShaderNode" + kind) for kind in ("TexCoord", "SeparateXYZ", "Math"))
    test.operation, test.inputs[1].default_value = "GREATER_THAN", 0.0
    tree.links.new(place.outputs["Object"], part.inputs[0])
    tree.links.new(part.outputs["X"], test.inputs[0])
    tree.links.new(test.outputs[0], bsdf.inputs["Emission Color"])
    cube.rsibr.map_set = "/job/pyramid.rsibr.exr"
    return test

def halves():
    # Mean brightness of the cube's halves
    picture = pixels().mean(axis=2)
    height, width = picture.shape
    rows = slice(height // 2 - 20, height // 2 + 20)
    middle, row = width // 2, picture[rows]
    return [float(row[:, middle + low : middle + high].mean()) for low, high in ((-40, -10), (10, 40))]

def settled(cube):
    # Until what the cube needs is shown
    inputs = session().previews.inputs
    while True:
        yield from drawn()
        wish, shown = inputs._wishes.get(cube.session_uid), inputs._shown.get(cube.session_uid)
        if wish and shown and wish.path == shown[0] and not session().bakes.busy:
            return
        assert not (wish and wish.trouble), wish.trouble
"""

EDITS = """
def scenario(told):
    cube, inputs = bpy.data.objects["Cube"], session().previews.inputs
    preferences = bpy.context.preferences.addons[ROOT].preferences
    preferences.bake_inputs = False
    test = glowing(cube)
    if {bare}:
        cube.data.uv_layers.remove(cube.data.uv_layers[0])
    while cube.session_uid not in inputs._wishes:
        yield from drawn()
    told["without"], told["queued"] = session().previews.messages(cube), len(session().bakes.bakes)
    preferences.bake_inputs = True
    bpy.ops.rsibr.bake_inputs(by_itself=True)
    told["asked"] = session().previews.messages(cube)
    yield from settled(cube)
    told["first"], told["messages"] = halves(), session().previews.messages(cube)
    baked = inputs._wishes[cube.session_uid].path
    test.operation = "LESS_THAN"
    while inputs._wishes[cube.session_uid].path == baked:  # until the edit has rested
        yield
    yield from settled(cube)
    told["second"] = halves()
    test.operation = "GREATER_THAN"  # which was baked before
    bpy.ops.rsibr.bake_inputs(by_itself=True)
    told["busy"] = session().bakes.busy
    yield from settled(cube)
    told["again"] = halves()
"""


@pytest.mark.parametrize("bare", [False, True])
def test_what_is_procedural_is_baked_and_shown(told: Told, bare: bool) -> None:
    answer = told(PRELUDE + EDITS.replace("{bare}", str(bare)))
    assert answer["without"][0] == "Materials need a bake: press Bake Materials."
    assert answer["queued"] == 0
    assert answer["asked"][0] == "Materials need a bake: baking."
    (dark, bright), (second_bright, second_dark) = answer["first"], answer["second"]
    assert dark < 5
    assert bright > 250
    assert second_dark < 5
    assert second_bright > 250
    assert bool(answer["messages"]) == bare  # faces are baked one by one
    assert not answer["busy"]
    assert answer["again"] == answer["first"]


WINDOWS = """
def scenario(told):
    # The first window shows an empty scene, the second the cube, as a modifier makes it
    cube, inputs = bpy.data.objects["Cube"], session().previews.inputs
    glowing(cube)
    cube.modifiers.new("Subdivision", "SUBSURF")
    with bpy.context.temp_override(window=window()):
        bpy.ops.wm.window_new_main()
    window().scene = bpy.data.scenes.new("Empty")
    while cube.session_uid not in inputs._shown:
        yield from drawn()
        wish = inputs._wishes.get(cube.session_uid)
        assert not (wish and wish.trouble), wish.trouble
    told["bakes"] = [[str(each.state), each.message] for each in session().bakes.bakes]
"""


def test_materials_of_another_window_s_scene_are_baked(told: Told) -> None:
    assert told(PRELUDE + WINDOWS) == {"bakes": [["done", ""]]}
