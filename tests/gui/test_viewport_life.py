"""Previews come, go, fail in words, and follow the file, in Blender's window."""

from collections.abc import Callable
from pathlib import Path

import pytest
from rsibr.tests.flat_capture import write_flat_capture

Told = Callable[[str], dict]


@pytest.fixture(autouse=True)
def _flat(job: Path) -> None:
    write_flat_capture(job / "flat.rsibr.exr", (0.5, 0.0, 0.5))
    (job / "flat.blend").unlink(missing_ok=True)
    (job / "later.rsibr.exr").unlink(missing_ok=True)


PRELUDE = """

def purple(number=0):
    return int(like(pixels(number), (188, 0, 188)).sum())

def held(previews=None):
    previews = previews or session().previews
    return [len(previews._layers.meshes), len(previews._map_sets.used), len(previews._layers.layers)]

def uploaded():
    previews = session().previews
    return [*previews._layers.meshes._uploaded.values(), *previews._map_sets.used.values()]

def previewed_cube():
    bare(view())
    bpy.context.scene.view_settings.view_transform = "Standard"
    cube = bpy.data.objects["Cube"]
    cube.rsibr.map_set = "/job/flat.rsibr.exr"
    return cube
"""

UNDO = """
def scenario(told):
    cube = previewed_cube()
    with bpy.context.temp_override(window=window()):
        bpy.ops.ed.undo_push(message="assigned")
        yield from drawn()
        told["before"] = purple()
        cube.scale = (0.5, 0.5, 0.5)
        bpy.ops.ed.undo_push(message="scaled")
        yield from drawn()
        told["scaled"] = purple()
        bpy.ops.ed.undo()
        yield from drawn()
        told["undone"] = purple()
        bpy.ops.ed.redo()
        yield from drawn()
        told["redone"] = purple()
        bpy.data.objects.remove(bpy.data.objects["Cube"])
        bpy.ops.ed.undo_push(message="removed")
        yield from drawn()
        told["removed"], told["held"] = purple(), held()
        bpy.ops.ed.undo()
        yield from drawn()
        told["back"], told["trouble"] = purple(), session().previews.faults.trouble
"""


def test_undo_and_redo(told: Told) -> None:
    answer = told(PRELUDE + UNDO)
    assert answer["before"] > 2 * answer["scaled"] > 1000
    assert answer["undone"] == answer["before"]
    assert answer["redone"] == answer["back"] == answer["scaled"]
    assert answer["removed"] == 0
    assert answer["held"][:2] == [0, 0]
    assert answer["trouble"] is None


RELOAD = """
def scenario(told):
    previewed_cube()
    yield from drawn()
    told["before"] = purple()
    bpy.data.objects["Cube"].rsibr.map_set = "//flat.rsibr.exr"
    with bpy.context.temp_override(window=window()):
        bpy.ops.wm.save_as_mainfile(filepath="/job/flat.blend")
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    told["held by an empty file"] = [*held(), len(session().previews._map_sets.unused)]
    yield from drawn()
    with bpy.context.temp_override(window=window()):
        bpy.ops.wm.open_mainfile(filepath="/job/flat.blend")
    yield from drawn()
    told["reopened"] = purple()
"""


def test_files_are_closed_and_opened(told: Told) -> None:
    answer = told(PRELUDE + RELOAD)
    assert answer["held by an empty file"] == [0, 0, 0, 0]
    assert answer["reopened"] == answer["before"] > 2000


DISABLE = """
import addon_utils

def scenario(told):
    previewed_cube()
    yield from drawn()
    told["before"] = purple()
    previews = session().previews
    addon_utils.disable(ROOT)
    yield from drawn()
    told["disabled"] = purple()
    told["held"] = [*held(previews), len(previews._map_sets.unused)]
    told["handlers"] = [
        function.__module__
        for name in dir(bpy.app.handlers)
        if isinstance(functions := getattr(bpy.app.handlers, name), list)
        for function in functions
        if "rsibr" in function.__module__
    ]
    told["property"] = hasattr(bpy.types.Object, "rsibr")
    addon_utils.enable(ROOT)
    yield from drawn()
    told["enabled"] = purple()
"""


def test_disabling_leaves_nothing_behind(told: Told) -> None:
    answer = told(PRELUDE + DISABLE)
    assert answer["enabled"] == answer["before"] > 2000
    assert (answer["disabled"], answer["held"]) == (0, [0, 0, 0, 0])
    assert (answer["handlers"], answer["property"]) == ([], False)


FAULT = """
import shutil

def scenario(told):
    cube = previewed_cube()
    other = bpy.data.objects.new("Other", cube.data.copy())
    bpy.context.collection.objects.link(other)
    other.location = (0.0, 2.5, 0.0)
    other.rsibr.map_set = "/job/flat.rsibr.exr"
    cube.rsibr.map_set = "/job/later.rsibr.exr"
    yield from drawn()
    told["missing"] = [purple(), *map(session().previews.faults.message, (cube, other))]
    shutil.copy("/job/flat.rsibr.exr", "/job/later.rsibr.exr")
    yield from drawn()
    told["still off"] = purple()
    cube.rsibr.show = False
    yield from drawn()
    told["hidden"] = [purple(), session().previews.faults.message(cube)]
    cube.rsibr.show = True
    yield from drawn()
    told["tried again"] = [purple(), session().previews.faults.message(cube), session().previews.kind(cube)]

    def broken(*arguments):
        told["draws"] = told.get("draws", 0) + 1
        raise OSError("the card is on fire")

    session().previews._map_sets.used["/job/later.rsibr.exr"].gpu_map_set.draw = broken
    yield from drawn()
    told["broken"] = [purple(), session().previews.faults.message(cube)]
"""


def test_what_fails_is_told_once_and_switched_off(told: Told) -> None:
    answer = told(PRELUDE + FAULT)
    sentence = "/job/later.rsibr.exr does not exist: check the name and the folder."
    alone, fault, other_fault = answer["missing"]
    assert alone > 2000
    assert (fault, other_fault) == (sentence, None)
    assert answer["still off"] == alone
    assert answer["hidden"] == [alone, None]
    both, fault, kind = answer["tried again"]
    assert both > 1.5 * alone
    assert (fault, kind) == (None, "radiance_views")
    assert answer["broken"] == [alone, "the card is on fire"]
    assert answer["draws"] == 1


TWO = """
def scenario(told):
    cube = previewed_cube()
    with bpy.context.temp_override(window=window(), area=view(), region=region(view())):
        bpy.ops.screen.area_split(direction="VERTICAL", factor=0.4)
    yield from drawn()
    bare(view(1))
    view(0).spaces.active.region_3d.view_perspective = "ORTHO"
    yield from drawn()
    told["both"] = [purple(0), purple(1)]
    meshes = uploaded()
    other = bpy.data.objects.new("Other", None)
    bpy.context.collection.objects.link(other)
    bpy.ops.object.select_all(action="DESELECT")
    other.select_set(True)
    with bpy.context.temp_override(window=window(), area=view(1), region=region(view(1))):
        bpy.ops.view3d.localview()
    yield from drawn()
    told["local view on nothing"] = [purple(0), purple(1)]
    told["meshes kept"] = uploaded() == meshes
"""


def test_two_viewports(told: Told) -> None:
    answer = told(PRELUDE + TWO)
    left, right = answer["both"]
    assert min(left, right) > 1000
    assert left != right
    assert answer["local view on nothing"] == [left, 0]
    assert answer["meshes kept"]


RENDER = """
import threading

def scenario(told):
    cube = previewed_cube()
    scene = bpy.context.scene
    bpy.context.preferences.view.render_display_type = "NONE"
    scene.render.engine, scene.cycles.samples, scene.cycles.use_denoising = "CYCLES", 4, False
    scene.render.resolution_x = scene.render.resolution_y = 64
    scene.frame_end, scene.render.filepath = 3, "/job/frame_"
    cube.keyframe_insert("location", frame=1)
    yield from drawn()
    told["before"] = purple()
    may_begin = threading.Event()
    bpy.app.handlers.render_pre.append(lambda *_: may_begin.wait())
    with bpy.context.temp_override(window=window()):
        bpy.ops.render.render("INVOKE_DEFAULT", animation=True)
    scene.view_settings.view_transform = "AgX"
    for _ in range(3):
        yield from drawn()
    told["while rendering"] = [bpy.app.is_job_running("RENDER"), len(session().previews._displays.textures)]
    may_begin.set()
    while bpy.app.is_job_running("RENDER"):
        yield from drawn()
    yield from drawn()
    told["displays"] = len(session().previews._displays.textures)
    scene.view_settings.view_transform = "Standard"
    yield from drawn()
    told["after"], told["trouble"] = purple(), session().previews.faults.trouble
"""


def test_renders_and_previews_leave_each_other_alone(told: Told) -> None:
    answer = told(PRELUDE + RENDER)
    assert answer["before"] == answer["after"] > 2000
    # A new view transform is learnt when the render has ended
    assert answer["while rendering"] == [True, 1]
    assert answer["displays"] == 2
    assert answer["trouble"] is None


LOOKS = """
def scenario(told):
    cube = previewed_cube()
    cube.modifiers.new("Smooth", "SUBSURF").levels = 2
    yield from drawn()
    before = uploaded()
    seen, gpu_map_set = [], next(iter(session().previews._map_sets.used.values())).gpu_map_set
    draw = gpu_map_set.draw

    def recorded(mesh, placed, look):
        seen.append([look.mode, look.warping])
        draw(mesh, placed, look)

    gpu_map_set.draw = recorded
    settings = bpy.context.window_manager.rsibr_view
    for group, field, value in (
        (cube.rsibr.radiance_views, "mode", "texel"),
        (cube.rsibr.radiance_views, "warping", "single"),
        (cube.rsibr, "follow_world", True),
        (settings, "split", True),
        (settings, "line", 0.7),
    ):
        count = len(seen)
        setattr(group, field, value)
        while len(seen) == count:
            yield
    told["seen"], told["kept"] = seen[-1], uploaded() == before
    cube.modifiers["Smooth"].levels = 1
    yield from drawn()
    told["kept another mesh"] = uploaded()[0] == before[0]
    told["held"] = held()
    count = len(seen)
    cube.rsibr.show = False
    yield from drawn()
    told["hidden"] = [purple(), len(seen) - count]
    cube.rsibr.show = True
    while not purple():
        yield
"""


def test_a_look_shows_at_once_and_uploads_nothing(told: Told) -> None:
    answer = told(PRELUDE + LOOKS)
    assert answer["seen"] == ["texel", "single"]
    assert answer["kept"]
    assert not answer["kept another mesh"]
    assert answer["held"][:2] == [1, 1]
    assert answer["hidden"] == [0, 0]


SWITCH = """
import shutil

def scenario(told):
    cube = previewed_cube()
    yield from drawn()
    first = uploaded()
    shutil.copy("/job/flat.rsibr.exr", "/job/later.rsibr.exr")
    cube.rsibr.map_set = "/job/later.rsibr.exr"
    yield from drawn()
    second = uploaded()
    told["another"] = second[1] == first[1]
    cube.rsibr.map_set = "/job/flat.rsibr.exr"
    yield from drawn()
    told["back"] = [purple(), uploaded() == first]
    shutil.copy("/job/flat.rsibr.exr", "/job/later.rsibr.exr")
    cube.rsibr.map_set = "/job/later.rsibr.exr"
    yield from drawn()
    told["written anew"] = [purple(), uploaded()[1] == second[1]]
"""


def test_going_back_to_a_map_set_uploads_nothing_unless_its_file_is_another(told: Told) -> None:
    answer = told(PRELUDE + SWITCH)
    shown, kept = answer["back"]
    assert shown > 2000
    assert kept
    assert not answer["another"]
    assert answer["written anew"] == [shown, False]
