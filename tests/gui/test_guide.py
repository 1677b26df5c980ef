"""The guide's first preview by mouse and keys alone; RSIBR_PICTURES=docs/images takes its pictures."""

import os
from collections.abc import Callable
from pathlib import Path

import bpy
from rsibr.tests.gui.panel import HANDS, PRELUDE

LARGEST = 150_000
"""Bytes of a picture."""

WAY = """
SIDEBAR = 766

def tidy():
    # Room for the panel, and a plain background; all else is done by hand
    space = view().spaces.active
    overlay = space.overlay
    space.show_region_header = space.show_region_tool_header = space.show_region_toolbar = False
    space.show_gizmo = overlay.show_text = overlay.show_floor = overlay.show_cursor = False
    overlay.show_axis_x = overlay.show_axis_y = overlay.show_outline_selected = False
    overlay.show_extras = overlay.show_object_origins = overlay.show_relationship_lines = False

def suzanne():
    # Instead of the cube, smooth, and as large as the viewport
    yield from key("DEL")
    yield from key("A", "A", shift=True)
    yield from look_up("monkey")
    picture("guide-add", 330, 330, 870, 450)
    yield from key("RET")
    yield from key("TWO", ctrl=True)
    yield from key("F3")
    yield from look_up("shade smooth")
    yield from key("RET")
    yield from key("NUMPAD_PERIOD")
    # From the front, and a little from the right and above
    yield from key("NUMPAD_1")
    for turn in ("NUMPAD_6", "NUMPAD_6", "NUMPAD_8", "NUMPAD_MINUS"):
        yield from key(turn)
    yield from drawn()

def open_tab():
    # The tabs' names cannot be asked for: try from below, where add-ons have theirs
    yield from key("N", "n")
    yield from drawn()
    part = next(each for each in view().regions if each.type == "UI")
    for y in range(part.y + part.height // 2, part.y + part.height, 15):
        if part.active_panel_category == "RSIBR":
            return
        yield from click(part.x + part.width - 12, y)

def scenario(told):
    tidy()
    yield from drawn()
    yield from suzanne()
    told["objects"] = sorted(each.name for each in bpy.data.objects if each.type == "MESH")
    yield from open_tab()
    picture("guide-tab", 360, 0, None, 530)
    clicks[:-1] = []  # all but the last one looked for the tab
    yield from push("bpy.ops.material.new(")
    yield from push("rsibr_bake.light")  # the middle one of three
    yield from choose("rsibr_bake.studio", "sunset")
    yield from drawn()  # with the light's picture, which Blender makes aside
    picture("guide-settings", SIDEBAR, 0, None, 400)
    yield from push("bpy.ops.rsibr.bake(", share=0.3)
    (bake,) = session().bakes.bakes
    told["clicks"] = len(clicks) + 2  # to open the list, and to choose in it, instead of the wheel
    yield from drawn()
    picture("guide-baking", SIDEBAR, 0, None, 480)
    yield from done()
    told["state"], told["message"] = str(bake.state), bake.message
    told["shaded"] = bool(bpy.context.object.rsibr.map_set)
    yield from drawn()
    told["messages"] = session().previews.messages(bpy.context.object)
    # As in Blender's material properties
    inputs = bpy.context.object.active_material.node_tree.nodes["Principled BSDF"].inputs
    inputs["Base Color"].default_value = (0.5, 0.03, 0.02, 1)
    inputs["Roughness"].default_value, inputs["Coat Weight"].default_value = 0.4, 1.0
    view().spaces.active.overlay.show_outline_selected = True
    for _ in range(3):
        yield from drawn()
    picture("guide-preview", 340, 0, None, 530)
"""


def test_the_first_preview(told: Callable[[str], dict], job: Path) -> None:
    assert told(PRELUDE + HANDS + WAY) == {
        "objects": ["Suzanne"],
        "clicks": 6,
        "state": "done",
        "message": "",
        "shaded": True,
        "messages": [],
    }
    if folder := os.environ.get("RSIBR_PICTURES"):
        for picture in job.glob("guide-*.png"):
            save_small(picture, Path(folder).resolve() / picture.name)


def save_small(picture: Path, to: Path) -> None:
    """Write a picture as small as PNG lets it be."""
    scene = bpy.context.scene
    settings = scene.render.image_settings
    settings.file_format, settings.color_mode, settings.compression = "PNG", "RGB", 100
    scene.view_settings.view_transform = "Standard"
    bpy.data.images.load(str(picture)).save_render(str(to), scene=scene)
    assert to.stat().st_size < LARGEST
