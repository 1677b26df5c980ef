"""What scenarios do with the panel: their own code, which runs in Blender after `in_window`."""

PRELUDE = """
import importlib, os, pathlib, signal
background = importlib.import_module(ROOT + ".operators.background")

def settings():
    chosen = bpy.context.scene.rsibr_bake
    chosen.kind, chosen.light, chosen.studio = "radiance_views", "STUDIO", "forest"
    views = chosen.radiance_views
    views.size, views.samples, views.denoise = 16, 2, False
    return chosen

def sidebar():
    area = view()
    area.spaces.active.show_region_ui = True
    return area, next(each for each in area.regions if each.type == "UI")

def tab():
    # Show ours
    yield from drawn()
    sidebar()
    yield from drawn()
    sidebar()[1].active_panel_category = "RSIBR"
    for _ in range(5):
        yield from drawn()

def only(first, *others):
    # Show these panels: the rest would push them down and out of sight
    for panel in reversed(bpy.types.Panel.__subclasses__()):
        if panel.__name__.startswith("RSIBR_PT_"):
            bpy.utils.unregister_class(panel)
    if hasattr(first, "bl_parent_id"):
        del first.bl_parent_id
    for panel in (first, *others):
        bpy.utils.register_class(panel)

def command_at(x, y):
    # What the button under the mouse does; empty where there is none
    wm = bpy.context.window_manager
    wm.clipboard = ""
    window().event_simulate(type="MOUSEMOVE", value="NOTHING", x=x, y=y)
    yield
    yield
    area, region = sidebar()
    with bpy.context.temp_override(window=window(), area=area, region=region):
        if bpy.ops.ui.copy_python_command_button.poll():
            bpy.ops.ui.copy_python_command_button()
    return wm.clipboard

def press(command):
    # Find the button that runs a command, by moving the mouse down the panel, and click it
    area, region = sidebar()
    x = region.x + region.width // 3
    for y in range(region.y + region.height - 10, region.y, -12):
        found = yield from command_at(x, y)
        if found.startswith(command):
            window().event_simulate(type="LEFTMOUSE", value="PRESS", x=x, y=y)
            yield
            window().event_simulate(type="LEFTMOUSE", value="RELEASE", x=x, y=y)
            yield
            return True
    return False

def done(until=lambda: not session().bakes.busy):
    while not until():
        yield

def finished_views(bake):
    return len(list(pathlib.Path(f"{bake.output}.partial").glob("view*.exr")))

def bake():
    with bpy.context.temp_override(window=window()):
        return list(bpy.ops.rsibr.bake("INVOKE_DEFAULT"))
"""

HANDS = """
def event(kind, value, x, y, **more):
    window().event_simulate(type=kind, value=value, x=x, y=y, **more)
    yield

clicks = []

def click(x, y):
    clicks.append((x, y))
    yield from event("MOUSEMOVE", "NOTHING", x, y)
    yield from event("LEFTMOUSE", "PRESS", x, y)
    yield from event("LEFTMOUSE", "RELEASE", x, y)
    yield from drawn()

def key(kind, letter=None, **modifiers):
    # Over the viewport
    part = region(view())
    x, y = part.x + part.width // 3, part.y + part.height // 2
    typed = {"unicode": letter} if letter else {}
    yield from event("MOUSEMOVE", "NOTHING", x, y)
    yield from event(kind, "PRESS", x, y, **typed, **modifiers)
    yield from event(kind, "RELEASE", x, y, **modifiers)

def look_up(words):
    # In a menu that searches
    for letter in words:
        yield from key("SPACE" if letter == " " else letter.upper(), letter)
    yield from drawn()

def name_at(x, y):
    # The setting or command under the mouse
    wm = bpy.context.window_manager
    wm.clipboard = ""
    yield from event("MOUSEMOVE", "NOTHING", x, y)
    yield
    area, part = sidebar()
    with bpy.context.temp_override(window=window(), area=area, region=part):
        for copy in (bpy.ops.ui.copy_data_path_button, bpy.ops.ui.copy_python_command_button):
            if not wm.clipboard and copy.poll():
                copy()
    return wm.clipboard

def find(name, share=0.5):
    # Where the sidebar shows it, looking from top to bottom at a share of its width
    part = sidebar()[1]
    x = part.x + int((part.width - 40) * share)
    for y in range(part.y + part.height - 12, part.y, -12):
        if name in (yield from name_at(x, y)):
            return x, y - 3
    raise AssertionError(f"the sidebar does not show {name}")

def push(name, share=0.5):
    yield from click(*(yield from find(name, share)))

def choose(name, value):
    # Turn the wheel over a list, with Ctrl held
    x, y = yield from find(name)
    for _ in range(20):
        if bpy.context.scene.path_resolve(name) == value:
            return
        yield from event("WHEELDOWNMOUSE", "PRESS", x, y, ctrl=True)
        yield
    raise AssertionError(f"{name} does not become {value}")

def scroll():
    # To the panel's end
    part = sidebar()[1]
    for _ in range(15):
        yield from event("WHEELDOWNMOUSE", "PRESS", part.x + part.width // 2, part.y + 200)
    yield from drawn()

def picture(name, left=3, top=0, right=None, bottom=None):
    # The viewport, or the part of it within these columns and rows, which count from its top left
    area = view()
    shown = xshot.grab()
    first = shown.shape[0] - area.y - area.height
    part = shown[first : first + area.height, area.x : area.x + area.width][top:bottom, left:right]
    xshot.save(part, f"/job/{name}.png")
"""
