"""Previews in own materials by clicks: slots, edits, the whole scene, and what is out of date."""

from collections.abc import Callable

from rsibr.tests.gui.panel import HANDS, PRELUDE

Told = Callable[[str], dict]

SCENE = """
PURPLE, TEAL, YELLOW = (0.5, 0.0, 0.5), (0.0, 0.5, 0.5), (0.5, 0.5, 0.0)
LEVEL = 188
"What 0.5 is on the display"

def glowing(name, colour):
    # Black but for what it emits, which no light changes
    material = bpy.data.materials.new(name)
    inputs = material.node_tree.nodes["Principled BSDF"].inputs
    inputs["Base Color"].default_value = (0, 0, 0, 1)
    inputs["Specular IOR Level"].default_value = 0.0
    inputs["Emission Color"].default_value, inputs["Emission Strength"].default_value = (*colour, 1), 1.0
    return material

def seen(colour):
    shown = pixels()[:, : sidebar()[1].x - view().x]
    return int(like(shown, [LEVEL if each else 0 for each in colour]).sum())

def two_slots():
    bare(view())
    scene = bpy.context.scene
    scene.view_settings.view_transform = "Standard"
    scene.rsibr_bake.kernel_pyramid.size = "256"
    cube = bpy.data.objects["Cube"]
    cube.data.materials.clear()
    for name, colour in (("Left", PURPLE), ("Right", TEAL)):
        cube.data.materials.append(glowing(name, colour))
    for face in cube.data.polygons:
        face.material_index = face.index % 2
    return cube

def fresh():
    # Until it has been looked, and nothing is baked; the looks come after an edit
    keep = importlib.import_module(ROOT + ".operators.keep_fresh")
    for _ in range(10):
        yield
    while bpy.app.timers.is_registered(keep._look) or session().bakes.busy:
        yield
    yield from drawn()
"""

SHADED = """
def scenario(told):
    cube = two_slots()
    yield from tab()
    yield from push("bpy.ops.rsibr.bake(", share=0.25)
    yield from done()
    yield from fresh()
    told["state"] = [[str(each.state), each.message] for each in session().bakes.bakes]
    told["slots"] = [seen(PURPLE), seen(TEAL), seen(YELLOW)]
    emission = cube.data.materials[0].node_tree.nodes["Principled BSDF"].inputs["Emission Color"]
    emission.default_value = (*YELLOW, 1)
    for _ in range(2):
        yield from drawn()
    told["edited"] = [seen(PURPLE), seen(TEAL), seen(YELLOW)]
    told["baked"] = len(session().bakes.bakes)
    # Another object is previewed with the whole scene, from the same file
    with bpy.context.temp_override(window=window(), area=view(), region=region(view())):
        bpy.ops.mesh.primitive_plane_add(location=(0, 0, 2))
    plane = bpy.context.object
    yield from tab()
    yield from push("bpy.ops.rsibr.preview_scene(", share=0.75)
    yield from fresh()
    told["scene"] = plane.rsibr.map_set == cube.rsibr.map_set != ""
    told["baked again"] = len(session().bakes.bakes)
"""

CHANGED = """
def scenario(told):
    cube, world = two_slots(), bpy.context.scene.world
    freshness = session().freshness
    yield from tab()
    yield from push("bpy.ops.rsibr.bake(", share=0.25)
    yield from done()
    yield from fresh()
    first = cube.rsibr.map_set
    told["up to date"] = freshness.stale[cube.session_uid] is None
    color = world.node_tree.nodes["Background"].inputs["Color"]
    color.default_value = (0.2, 0.4, 0.6, 1)
    yield from done(lambda: session().bakes.busy)
    told["said"] = freshness.of(cube).reason
    yield from fresh()
    second = cube.rsibr.map_set
    told["rebaked"] = second != first, freshness.of(cube) is None
    cube.rsibr.follow_world = False
    color.default_value = (0.6, 0.4, 0.2, 1)
    yield from fresh()
    told["not followed"] = freshness.of(cube).reason, cube.rsibr.map_set == second
    yield from push("bpy.ops.rsibr.rebake(", share=0.75)
    yield from done()
    yield from fresh()
    told["asked for"] = cube.rsibr.map_set not in (first, second), freshness.of(cube) is None
    os.remove(bpy.path.abspath(cube.rsibr.map_set))
    bpy.ops.rsibr.reload_map_sets()
    yield from tab()
    told["find"] = bool((yield from find("bpy.ops.rsibr.assign(", share=0.25)))
"""


def test_an_object_is_shaded_in_the_materials_of_its_slots_and_edits_show_at_once(told: Told) -> None:
    answer = told(PRELUDE + HANDS + SCENE + SHADED)
    purple, teal, yellow = answer.pop("slots")
    assert min(purple, teal) > 1000
    assert yellow == 0
    # The same pixels, but for those on edges
    edited = answer.pop("edited")
    assert edited[0] == 0
    assert abs(edited[1] - teal) + abs(edited[2] - purple) < 100
    assert answer == {"state": [["done", ""]], "baked": 1, "scene": True, "baked again": 1}


def test_what_is_out_of_date_says_so_and_is_baked_anew(told: Told) -> None:
    assert told(PRELUDE + HANDS + SCENE + CHANGED) == {
        "up to date": True,
        "said": "World changed",
        "rebaked": [True, True],
        "not followed": ["World changed", True],
        "asked for": [True, True],
        "find": True,
    }
