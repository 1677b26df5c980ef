"""Objects in their own materials, in Blender's window: whatever is edited shows, and undo takes it back."""

from collections.abc import Callable
from pathlib import Path

import pytest
from rsibr.rsibr_addon.files.map_set import write_map_set
from rsibr.tests.faults.small_map_sets import map_sets

Told = Callable[[str], dict]


@pytest.fixture(autouse=True)
def _pyramid(job: Path) -> None:
    (pyramid,) = (each for each in map_sets() if each.kind == "kernel_pyramid")
    write_map_set(job / "pyramid.rsibr.exr", pyramid, force=True)


PRELUDE = """
RED, PURPLE, GREEN = (0.5, 0.0, 0.0), (0.5, 0.0, 0.5), (0.0, 0.5, 0.0)

def shining(name, color):
    # Reflects nothing: its light is its colour
    material = bpy.data.materials.new(name)
    inputs = bsdf(material).inputs
    inputs["Base Color"].default_value = (0.0, 0.0, 0.0, 1.0)
    inputs["Specular IOR Level"].default_value = 0.0
    inputs["Emission Strength"].default_value = 1.0
    inputs["Emission Color"].default_value = (*color, 1.0)
    return material

def bsdf(material):
    return material.node_tree.nodes["Principled BSDF"]

def seen():
    shown = pixels()
    colors = {"red": RED, "purple": PURPLE, "green": GREEN}
    counts = {
        name: int(like(shown, tuple(188 if each else 0 for each in color)).sum())
        for name, color in colors.items()
    }
    return sorted(name for name, count in counts.items() if count > 100)

def previewed_cube():
    bare(view())
    bpy.context.scene.view_settings.view_transform = "Standard"
    cube = bpy.data.objects["Cube"]
    cube.data.materials[0] = shining("first", RED)
    cube.rsibr.map_set = "/job/pyramid.rsibr.exr"
    return cube
"""

EDITS = """
def scenario(told):
    cube = previewed_cube()
    first = bpy.data.materials["first"]
    color = bsdf(first).inputs["Emission Color"]
    yield from drawn()
    told["first"] = seen()
    color.default_value = (*PURPLE, 1.0)
    yield from drawn()
    told["slider"] = seen()
    cube.data.materials.append(shining("second", GREEN))
    for polygon in list(cube.data.polygons)[::2]:
        polygon.material_index = 1
    cube.data.update()
    yield from drawn()
    told["slot"] = seen()
    image = bpy.data.images.new("painted", 4, 4, float_buffer=True)
    image.pixels[:] = [*RED, 1.0] * 16
    node = first.node_tree.nodes.new("ShaderNodeTexImage")
    node.image = image
    first.node_tree.links.new(node.outputs["Color"], color)
    yield from drawn()
    told["image"] = seen()
    image.pixels[:] = [*PURPLE, 1.0] * 16
    image.update()
    yield from drawn()
    told["painted"] = seen()
    bpy.data.materials.remove(bpy.data.materials["second"])
    cube.data.materials.pop()
    yield from drawn()
    told["removed"] = seen()
    previews = session().previews
    told["said"] = [previews.messages(cube), previews.faults.trouble]
"""

UNDO = """
def scenario(told):
    cube = previewed_cube()
    with bpy.context.temp_override(window=window()):
        bpy.ops.ed.undo_push(message="assigned")
        yield from drawn()
        color = bsdf(bpy.data.materials["first"]).inputs["Emission Color"]
        color.default_value = (*PURPLE, 1.0)
        bpy.ops.ed.undo_push(message="edited")
        yield from drawn()
        told["edited"] = seen()
        bpy.ops.ed.undo()
        yield from drawn()
        told["undone"] = seen()
        bpy.data.materials.remove(bpy.data.materials["first"])
        bpy.ops.ed.undo_push(message="removed")
        yield from drawn()
        told["removed"] = seen()
        bpy.ops.ed.undo()
        yield from drawn()
        told["back"], told["trouble"] = seen(), session().previews.faults.trouble
"""

FRAMES = """
def scenario(told):
    previewed_cube()
    color = bsdf(bpy.data.materials["first"]).inputs["Emission Color"]
    for frame, value in ((1, RED), (10, PURPLE)):
        color.default_value = (*value, 1.0)
        color.keyframe_insert("default_value", frame=frame)
    for frame in (1, 10):
        bpy.context.scene.frame_set(frame)
        yield from drawn()
        told[str(frame)] = seen()
"""


def test_edits_show(told: Told) -> None:
    answer = told(PRELUDE + EDITS)
    assert answer["first"] == ["red"]
    assert answer["slider"] == ["purple"]
    assert answer["slot"] == ["green", "purple"]
    assert answer["image"] == ["green", "red"]
    assert answer["painted"] == ["green", "purple"]
    assert answer["removed"] == ["purple"]
    assert answer["said"] == [[], None]


def test_undo_and_redo(told: Told) -> None:
    answer = told(PRELUDE + UNDO)
    assert answer["edited"] == ["purple"]
    assert answer["undone"] == answer["back"] == ["red"]
    assert answer["removed"] == []
    assert answer["trouble"] is None


def test_keys_are_followed(told: Told) -> None:
    answer = told(PRELUDE + FRAMES)
    assert (answer["1"], answer["10"]) == (["red"], ["purple"])
