"""The guide's first preview, as a newcomer comes to it; RSIBR_PICTURES=docs/images takes its pictures."""

import os
from collections.abc import Callable
from pathlib import Path

import bpy
from rsibr.tests.gui.test_panel import PRELUDE

LARGEST = 150_000
"""Bytes of a picture."""

WAY = """
def picture(name, left=3):
    # The viewport from some column on, with the sidebar
    area = view()
    shown = xshot.grab()
    top = shown.shape[0] - area.y - area.height
    xshot.save(shown[top : top + area.height, left : area.x + area.width], f"/job/{name}.png")

def scroll():
    # To the panel's end
    region = sidebar()[1]
    for _ in range(12):
        window().event_simulate(
            type="WHEELDOWNMOUSE", value="PRESS", x=region.x + region.width // 2, y=region.y + 300
        )
        yield

def look():
    for _ in range(4):
        yield from drawn()

def scenario(told):
    space = view().spaces.active
    space.show_region_header = space.show_region_tool_header = space.overlay.show_text = False
    space.region_3d.view_distance, space.region_3d.view_location = 8.5, (0.7, 0.7, 0.0)
    space.show_region_toolbar = space.overlay.show_floor = space.overlay.show_axis_x = False
    space.overlay.show_axis_y = space.overlay.show_cursor = space.overlay.show_outline_selected = False
    space.overlay.show_extras = space.overlay.show_object_origins = space.show_gizmo = False
    space.overlay.show_relationship_lines = False
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    with bpy.context.temp_override(window=window(), area=view(), region=region(view())):
        bpy.ops.mesh.primitive_monkey_add(size=4.0, rotation=(0.0, 0.0, 0.7))
    monkey = bpy.context.object
    monkey.modifiers.new("Subdivision", "SUBSURF").levels = 2
    monkey.data.shade_smooth()
    sidebar()
    yield from look()
    sidebar()[1].active_panel_category = "RSIBR"
    chosen = bpy.context.scene.rsibr_bake
    chosen.light, chosen.studio, chosen.kind = "STUDIO", "sunset", "lobe_stack"
    chosen.lobe_stack.brdf = "ggx:alpha=0.15,metal=gold"
    yield from look()
    told["good"] = yield from press("bpy.ops.rsibr.apply_quality(quality='GOOD'")
    yield from look()
    picture("guide-settings", left=766)
    told["bake"] = yield from press("bpy.ops.rsibr.bake(")
    bake = background.queue.bakes[0]
    yield from done(lambda: bake.progress is not None or bake.ended)
    yield from scroll()
    yield from look()
    picture("guide-baking", left=766)
    yield from done()
    told["state"], told["message"] = str(bake.state), bake.message
    yield from scroll()
    yield from look()
    picture("guide-preview")
    told["map set"] = monkey.rsibr.map_set
"""


def test_the_first_preview(told: Callable[[str], dict], job: Path) -> None:
    answer = told(PRELUDE + WAY)
    assert answer.pop("map set").endswith(".rsibr.exr")
    assert answer == {"good": True, "bake": True, "state": "done", "message": ""}
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
