"""Reflection tables painted in Blender's window: strokes show in the viewport, and undo takes them back."""

from collections.abc import Callable

import pytest
from rsibr.tests.gui.panel import PRELUDE

PAINTING = """
def stroke(editor):
    # Over all of the image, with a brush that covers it
    mode = bpy.context.tool_settings.image_paint
    settings = mode.unified_paint_settings
    settings.size, settings.color = 400, (0.0, 0.0, 1.0)
    mode.brush.strength = 1.0
    within = region(editor)
    places = [(within.x + within.width * part // 10, within.y + within.height // 2) for part in range(1, 10)]
    window().event_simulate(type="MOUSEMOVE", value="NOTHING", x=places[0][0], y=places[0][1])
    yield
    window().event_simulate(type="LEFTMOUSE", value="PRESS", x=places[0][0], y=places[0][1])
    yield
    for x, y in places:
        window().event_simulate(type="MOUSEMOVE", value="NOTHING", x=x, y=y)
        yield
    window().event_simulate(type="LEFTMOUSE", value="RELEASE", x=places[-1][0], y=places[-1][1])
    yield

def scenario(told):
    bare(view())
    bpy.context.scene.view_settings.view_transform = "Standard"
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    with bpy.context.temp_override(window=window(), area=view(), region=region(view())):
        bpy.ops.mesh.primitive_uv_sphere_add(segments=64, ring_count=32, radius=2.5)
        bpy.ops.object.shade_smooth()
    ball = bpy.context.object
    tables = {"filepath": "/job/tables.rsibr.exr", "environment": "sunset"}
    bpy.ops.rsibr.bake_reflection_tables(**tables, preset="clay")
    bpy.ops.rsibr.assign(filepath=tables["filepath"])
    editor = next(each for each in window().screen.areas if each.type == "DOPESHEET_EDITOR")
    editor.type = "IMAGE_EDITOR"
    yield from drawn_with_news()
    yield from done()
    yield from drawn_with_news()
    told["before"] = middle()
    with bpy.context.temp_override(window=window(), area=view(), region=region(view())):
        bpy.ops.rsibr.edit_as_images()
    yield from drawn_with_news()
    told["editor"] = [editor.spaces.active.image.name, editor.spaces.active.mode]
    told["untouched"] = middle()
    bpy.ops.ed.undo_push(message="made images")
    with bpy.context.temp_override(window=window(), area=editor, region=region(editor)):
        bpy.ops.image.view_all(fit_view=True)
    yield from drawn_with_news()
    yield from stroke(editor)
    yield from drawn_with_news()
    yield from drawn_with_news()
    xshot.save(xshot.grab(), "/job/painted.png")
    told["painted"] = middle()
    with bpy.context.temp_override(window=window(), area=editor, region=region(editor)):
        bpy.ops.ed.undo()
    yield from drawn_with_news()
    yield from drawn_with_news()
    told["undone"] = middle()
    yield from tab()
    only(bpy.types.RSIBR_PT_result)
    yield from drawn_with_news()
    xshot.save(xshot.grab(), "/job/panel.png")
    told["pressed"] = yield from press("bpy.ops.rsibr.save_back(")
    yield from drawn_with_news()
    told["after"] = [os.path.basename(ball.rsibr.map_set)[:15], len(ball.rsibr.painted)]
"""


def test_strokes_show_and_are_undone_and_the_panel_saves_them(told: Callable[[str], dict]) -> None:
    answer = told(PRELUDE + PAINTING)
    assert answer["editor"] == ["tables diffuse", "PAINT"]
    assert answer["untouched"] == pytest.approx(answer["before"], abs=2.0)
    red, _, blue = answer["painted"]
    assert blue - red > answer["before"][2] - answer["before"][0] + 30.0
    assert answer["undone"] == pytest.approx(answer["before"], abs=2.0)
    assert answer["after"] == ["tables-painted-", 0]
