"""The artist's scene is left as it was: all properties of all data-blocks, before and after every button."""

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
from rsibr.rsibr_addon.files.png import png_of
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance
from rsibr.tests.gui.panel import PRELUDE

PANELS = Path(__file__).parents[2] / "rsibr_addon" / "ui"

IN_A_FILE_MENU = {"export_for_engine"}
"""Buttons of modules of the panels that are no panel's."""

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
            # Without pictures of light, which are asked for
            if isinstance(block, bpy.types.ID) and not block.name.endswith((".rsibr.exr", "light.exr")):
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
import webbrowser
opened = []
webbrowser.open = opened.append

def scenario(told):
    scene, cube = rich_scene()
    chosen = scene.rsibr_bake
    yield from drawn()
    before, living = contents(), particles(cube)
    assert living > 0
    told["particles"] = []
    told["properties"] = len(before)
    changed, pressed = {}, set()
    told["changed"] = changed

    def after(name, idle=lambda: not session().bakes.busy):
        yield from done(idle)
        for _ in range(2):
            yield from drawn()
        now = contents()
        differing = [path for path in before.keys() | now.keys() if before.get(path) != now.get(path)]
        if particles(cube) != living:
            told["particles"].append(f"{name} {particles(cube)} of {living}")
        if differing:
            changed[name] = [[path, str(before.get(path)), str(now.get(path))] for path in differing[:8]]

    def press_all(buttons):
        for name, arguments in buttons:
            pressed.add(name)
            with bpy.context.temp_override(window=window(), area=view(), region=region(view())):
                getattr(bpy.ops.rsibr, name)(**arguments)
            yield from after(f"{name} {arguments}")

    def drag_the_line(ending):
        pressed.add("drag_split")
        with bpy.context.temp_override(window=window(), area=view(), region=region(view())):
            bpy.ops.rsibr.drag_split("INVOKE_DEFAULT")
        window().event_simulate(type="MOUSEMOVE", value="NOTHING", x=region(view()).x + 200, y=300)
        yield
        window().event_simulate(type=ending, value="PRESS", x=region(view()).x + 200, y=300)
        yield from after(f"line {ending}", lambda: not window().modal_operators)

    yield from press_all([("apply_quality", {"quality": "DRAFT"}), ("bake", {}), ("preview_scene", {})])
    told["shaded"] = bool(cube.rsibr.map_set)
    path = bpy.path.abspath(cube.rsibr.map_set)
    yield from press_all(
        [
            ("rebake", {}),
            ("bake_look", {}),
            ("bake_again", {}),
            ("pack", {}),
            ("unpack", {}),
            ("accept", {}),
            ("reload_map_sets", {}),
            ("open_report", {"open_browser": False}),
            ("export_page", {"filepath": "/job/untouched.html"}),
            ("cancel_bake", {"number": 0}),
            ("assign", {"filepath": path}),
            ("bake_inputs", {}),
        ]
    )
    yield from drag_the_line("LEFTMOUSE")
    told["line"] = round(bpy.context.window_manager.rsibr_view.line * region(view()).width)
    yield from drag_the_line("ESC")
    # One material by sliders can be compared
    cube.rsibr.kernel_pyramid.own = False
    yield from press_all([("compare", {}), ("open_comparison", {})])
    told["opened"] = len(opened)
    # Images are made, and gone with what ends painting
    tables = {"filepath": "/job/untouched-tables.rsibr.exr", "environment": "sunset"}
    bpy.ops.rsibr.bake_reflection_tables(**tables, preset="clay", diffuse_rows=8)
    bpy.ops.rsibr.assign(filepath=tables["filepath"])
    for ending in ("save_back", "discard_paint"):
        bpy.ops.rsibr.edit_as_images()
        pressed.add("edit_as_images")
        yield from press_all([(ending, {})])
    libraries = bpy.context.preferences.filepaths.asset_libraries
    known = len(libraries)
    pressed.add("add_materials")
    bpy.ops.rsibr.add_materials()
    yield from press_all([("cancel_bake", {"number": 0})])
    told["libraries"] = [os.path.isdir(each.path) for each in libraries][known:]
    yield from press_all(
        [
            ("capture_environment", CAPTURE),
            ("merge_brackets", BRACKET),
            ("unwrap_ball", BALL),
            ("assemble_faces", {"filepath": "/job/cube-px.png", "size": 16, "use": True}),
            ("lift_painting", {"filepath": "/job/painting.png", "use": True}),
            ("convert_light", CONVERSION),
        ]
    )
    told["lights"] = sorted(each.name for each in bpy.data.images if each.name.endswith("light.exr"))
    # A bake of the world and of the object's own material: both go with a copy of the file
    chosen.kind, chosen.light = "radiance_views", "WORLD"
    views = chosen.radiance_views
    views.size, views.samples, views.denoise, views.views = 16, 1, False, "12"
    # To a farm that is not there
    preferences = bpy.context.preferences
    preferences.addons[ROOT].preferences.farm_manager = "127.0.0.1:9"
    preferences.system.use_online_access = True
    yield from press_all([("send_to_farm", {}), ("bake", {})])
    told["bakes"] = [[str(each.state), each.message] for each in session().bakes.bakes]
    # Switches of the panel
    view_settings = bpy.context.window_manager.rsibr_view
    for beyond in ("blender", "difference", "other"):
        view_settings.split, view_settings.beyond = True, beyond
        yield from after(beyond)
    cube.rsibr.live.on = True
    yield from after("live light")
    told["pressed"] = sorted(pressed)

CAPTURE = {"filepath": "/job/captured-light.exr", "size": 16, "samples": 1, "use": True}
BALL = {"filepath": "/job/ball.exr", "circle": (32, 32, 20), "size": 16, "use": True}
BRACKET = {"filepath": "/job/a.exr", "directory": "/job", "times": "0.1 0.5", "align": False}
CONVERSION = {"filepath": "/job/ball.exr", "source_layout": "angular_map", "use": True}
CONVERSION["output"] = "converted-light.exr"
BRACKET["files"] = [{"name": "a.exr"}, {"name": "b.exr"}]
"""


def write_pictures(job: Path) -> None:
    """Of which light is made: a bracket, a ball, six faces and a painting."""
    ramp = np.linspace(0.05, 0.9, 64 * 64 * 3).reshape(64, 64, 3)
    painted = np.concatenate([255.0 * ramp, np.full((64, 64, 1), 255.0)], axis=-1).astype(np.uint8)
    for name, time in (("a", 0.1), ("b", 0.5), ("ball", 1.0)):
        write_radiance(job / f"{name}.exr", (ramp * time).astype(np.float32))
    for face in ("px", "nx", "py", "ny", "pz", "nz"):
        (job / f"cube-{face}.png").write_bytes(png_of(painted))
    (job / "painting.png").write_bytes(png_of(painted[:32]))


def test_no_button_changes_anything_but_ours(told: Callable[[str], dict], job: Path) -> None:
    write_pictures(job)
    answer = told(PRELUDE + CONTENTS + SCENE + BUTTONS)
    assert answer.pop("properties") > 5000
    sources = "".join(path.read_text() for path in PANELS.glob("*.py"))
    buttons = set(re.findall(r'operator\(\s*"rsibr\.(\w+)"', sources)) - IN_A_FILE_MENU
    right = {
        "pressed": sorted(buttons),
        "changed": {},
        "particles": [],
        "shaded": True,
        "line": 200,
        "opened": 2,
        "libraries": [True],
        "lights": [
            "a-light.exr",
            "ball-light.exr",
            "captured-light.exr",
            "converted-light.exr",
            "cube-light.exr",
            "painting-light.exr",
        ],
        "bakes": [["done", ""]],
    }
    assert answer.keys() == right.keys()
    for name, value in right.items():
        assert answer[name] == value, name
