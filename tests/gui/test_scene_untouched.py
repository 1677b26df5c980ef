"""The artist's scene is left as it was: all properties of all data-blocks, before and after every button."""

from collections.abc import Callable

from rsibr.tests.gui.test_panel import PRELUDE

CONTENTS = """
APART = {"window_managers", "screens", "workspaces", "all_ids"}
"What the mouse changes, and a list of all data-blocks"

PASSING = {"rna_type", "bl_rna", "is_updated", "is_updated_data", "is_evaluated", "preview", "users"}
PASSING |= {"depsgraph", "bindcode", "has_data"}
# How much of a simulation is in memory: any property of an object that is set has Blender compute it anew
PASSING |= {"info", "is_frame_skip", "is_outdated"}
"What Blender keeps for itself"

def contents():
    # Path of each property -> its value; without ours
    found = {}
    for prop in bpy.data.bl_rna.properties:
        if prop.type != "COLLECTION" or prop.identifier in APART:
            continue
        for block in getattr(bpy.data, prop.identifier):
            if isinstance(block, bpy.types.ID) and not block.name.endswith(".rsibr.exr"):
                walk(block, f"{prop.identifier}[{block.name}]", found, set())
    return found

def walk(struct, path, found, above):
    if struct.as_pointer() in above or len(above) > 8:
        return
    for prop in struct.bl_rna.properties:
        name = prop.identifier
        if name in PASSING or name.startswith("rsibr"):
            continue
        try:
            value = getattr(struct, name)
        except (AttributeError, RuntimeError):  # of another state, as pixels of an image that is not loaded
            continue
        keep(value, prop, f"{path}.{name}", found, above | {struct.as_pointer()})

def keep(value, prop, path, found, above):
    if prop.type == "POINTER":
        if isinstance(value, bpy.types.ID) and not value.is_embedded_data:
            found[path] = (type(value).__name__, value.name)
        elif value is not None:
            walk(value, path, found, above)
    elif prop.type == "COLLECTION":
        found[path] = len(value)
        for number, each in enumerate(value):
            if each is None or isinstance(each, bpy.types.ID):
                found[f"{path}[{number}]"] = each and each.name
            else:
                walk(each, f"{path}[{number}]", found, above)
    elif isinstance(value, (str, int, float, bool, bytes)) or value is None:
        found[path] = value
    else:
        members = sorted(value) if isinstance(value, set) else value
        found[path] = repr([tuple(each) if hasattr(each, "__len__") else each for each in members])
"""

SCENE = """
def rich_scene():
    # Of what has been lost once: particles and relative paths; and of many kinds
    scene, cube = bpy.context.scene, bpy.data.objects["Cube"]
    image = bpy.data.images.new("Grid", 8, 8)
    image.filepath_raw, image.file_format = "/job/grid.png", "PNG"
    image.save()
    with bpy.context.temp_override(window=window()):
        bpy.ops.wm.save_as_mainfile(filepath="/job/artist.blend")
    image.filepath = "//grid.png"
    tree = cube.active_material.node_tree
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.image = image
    tree.links.new(texture.outputs["Color"], tree.nodes["Principled BSDF"].inputs["Base Color"])
    cube.modifiers.new("Subdivision", "SUBSURF")
    cube.modifiers.new("Particles", "PARTICLE_SYSTEM")
    cube.driver_add("location", 0).driver.expression = "0.5"
    cube.keyframe_insert("scale", frame=1)
    cube["theirs"] = 3.0
    text = bpy.data.objects.new("Text", bpy.data.curves.new("Text", "FONT"))
    scene.collection.objects.link(text)
    scene.collection.children.link(bpy.data.collections.new("Empty"))
    for frame in range(1, 7):
        scene.frame_set(frame)
    bpy.context.view_layer.objects.active = cube
    for item in scene.objects:
        item.select_set(item in (cube, text))
    return scene, cube

def particles(cube):
    evaluated = cube.evaluated_get(bpy.context.evaluated_depsgraph_get())
    return sum(each.alive_state == "ALIVE" for each in evaluated.particle_systems[0].particles)
"""

BUTTONS = """
def scenario(told):
    scene, cube = rich_scene()
    chosen = scene.rsibr_bake
    yield from drawn()
    before, living = contents(), particles(cube)
    told["properties"] = len(before)
    changed = told["changed"] = {}

    def after(name, idle=lambda: not session().bakes.busy):
        yield from done(idle)
        for _ in range(2):
            yield from drawn()
        now = contents()
        differing = [path for path in before.keys() | now.keys() if before.get(path) != now.get(path)]
        told["particles"] = told.get("particles", True) and particles(cube) == living > 0
        if differing:
            changed[name] = [[path, str(before.get(path)), str(now.get(path))] for path in differing[:8]]

    def press_all(buttons):
        for name, arguments in buttons:
            with bpy.context.temp_override(window=window(), area=view(), region=region(view())):
                getattr(bpy.ops.rsibr, name)(**arguments)
            yield from after(f"{name} {arguments}")

    yield from press_all([("apply_quality", {"quality": "DRAFT"}), ("bake", {}), ("preview_scene", {})])
    told["shaded"] = bool(cube.rsibr.map_set)
    path = bpy.path.abspath(cube.rsibr.map_set)
    yield from press_all(
        [
            ("rebake", {}),
            ("bake_again", {}),
            ("pack", {}),
            ("unpack", {}),
            ("accept", {}),
            ("reload_map_sets", {}),
            ("open_report", {"open_browser": False}),
            ("cancel_bake", {"number": 0}),
            ("assign", {"filepath": path}),
        ]
    )
    # A bake of the world and of the object's own material: both go with a copy of the file
    chosen.kind, chosen.light = "radiance_views", "WORLD"
    views = chosen.radiance_views
    views.size, views.samples, views.denoise, views.views = 16, 1, False, "12"
    yield from press_all([("bake", {})])
    told["bakes"] = [[str(each.state), each.message] for each in session().bakes.bakes]
    # Switches of the panel
    view_settings = bpy.context.window_manager.rsibr_view
    for beyond in ("blender", "difference", "other"):
        view_settings.split, view_settings.beyond = True, beyond
        yield from after(beyond)
    cube.rsibr.live.on = True
    yield from after("live light")
"""


def test_no_button_changes_anything_but_ours(told: Callable[[str], dict]) -> None:
    answer = told(PRELUDE + CONTENTS + SCENE + BUTTONS)
    assert answer.pop("properties") > 5000
    assert answer == {"changed": {}, "particles": True, "shaded": True, "bakes": [["done", ""]]}
