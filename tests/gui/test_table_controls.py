"""The parts of reflection tables by sliders, colours and curves in Blender's window: live, or baked anew."""

from collections.abc import Callable

from rsibr.tests.gui.panel import PRELUDE

Told = Callable[[str], dict]

CONTROLS = """
def scenario(told):
    bare(view())
    bpy.context.scene.view_settings.view_transform = "Standard"
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    with bpy.context.temp_override(window=window(), area=view(), region=region(view())):
        bpy.ops.mesh.primitive_uv_sphere_add(segments=64, ring_count=32, radius=2.5)
        bpy.ops.object.shade_smooth()
    ball, chosen = bpy.context.object, bpy.context.scene.rsibr_bake
    chosen.kind, chosen.light, chosen.studio = "reflection_tables", "STUDIO", "city"
    chosen.reflection_tables.preset = "plastic"
    yield from drawn()
    told["began"] = bake()
    yield from done()
    sidebar()
    yield from drawn()
    sidebar()[1].active_panel_category = "RSIBR"
    only(bpy.types.RSIBR_PT_look)
    parts = ball.rsibr.reflection_tables
    yield from drawn_with_news()
    told["baked"] = [parts.diffuse_model, parts.specular_n, parts.coat_model]
    told["red"] = middle()
    parts.diffuse_kd = (0.02, 0.5, 0.02)
    yield from drawn_with_news()
    told["green"] = middle()
    parts.weights_model = "curve"
    yield from drawn_with_news()
    xshot.save(xshot.grab(), "/job/curves.png")
    mapping = parts.weights_curves.nodes["wd"].mapping
    mapping.curves[0].points[1].location = (1.0, 0.0)
    mapping.update()
    sidebar()[1].tag_redraw()  # as the widget does where one drags a point
    yield from drawn_with_news()
    yield from done(lambda: parts.weights == "curve:wd=0:1/1:0,ws=0:1/1:1")
    yield from drawn_with_news()
    told["dark"] = middle()
    parts.weights = ""
    parts.specular_n = 80.0
    yield from drawn_with_news()
    told["messages"] = session().previews.messages(ball)
    xshot.save(xshot.grab(), "/job/other-table.png")
    before = ball.rsibr.map_set
    told["pressed"] = yield from press("bpy.ops.rsibr.bake_look(")
    yield from done()
    yield from drawn_with_news()
    told["after"] = [ball.rsibr.map_set != before, session().previews.messages(ball)]
    told["settings"] = [ball.rsibr_baked.reflection_tables.specular, ball.rsibr_baked.reflection_tables.coat]
    xshot.save(xshot.grab(), "/job/baked.png")
"""


def test_parts_are_live_and_other_tables_are_baked(told: Told) -> None:
    answer = told(PRELUDE + CONTROLS)
    assert answer["began"] == ["FINISHED"]
    assert answer["baked"] == ["lambert", 50.0, "none"]
    red, green, dark = answer["red"], answer["green"], answer["dark"]
    assert red[0] > red[1] + 20.0
    assert green[1] > green[0] + 20.0
    assert dark[1] < green[1] - 20.0  # what faces the eye has lost its diffuse light
    assert answer["messages"] == ["The specular table is another one for this material: bake it again."]
    assert answer["pressed"]
    assert answer["after"] == [True, []]
    assert answer["settings"] == ["phong:ks=0.3,n=80", ""]
