"""An artist's way through the panel in Blender's window: bake, cancel, go on, and what goes wrong."""

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from rsibr.tests.gui.panel import PRELUDE

Told = Callable[[str], dict]


@pytest.fixture(autouse=True)
def _nothing_baked(job: Path) -> None:
    for folder in [job / "rsibr", *job.glob("user/extensions/.user/*/rsibr/baked")]:
        shutil.rmtree(folder, ignore_errors=True)


WAY = """
def scenario(told):
    bare(view())
    bpy.context.scene.view_settings.view_transform = "Standard"
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    with bpy.context.temp_override(window=window(), area=view(), region=region(view())):
        bpy.ops.mesh.primitive_monkey_add(size=3.0)
    monkey = bpy.context.object
    chosen = settings()
    chosen.kind, chosen.mip_chain.size, chosen.mip_chain.filter = "mip_chain", "64", "box"
    sidebar()
    yield from drawn()
    sidebar()[1].active_panel_category = "RSIBR"
    for _ in range(5):
        yield from drawn()
    before = pixels()
    told["pressed"] = yield from press("bpy.ops.rsibr.bake(")
    told["bakes"] = len(session().bakes.bakes)
    told["file"] = bpy.data.filepath
    yield from done()
    told["state"] = [str(each.state) for each in session().bakes.bakes]
    told["message"] = [each.message for each in session().bakes.bakes]
    told["map set"] = os.path.basename(monkey.rsibr.map_set)
    # Of each its job, in a folder of its own
    folders = [each.command[-4] for each in session().bakes.bakes]
    told["left behind"] = [each for each in folders if os.path.exists(each)]
    for _ in range(3):
        yield from drawn()
    # Only the monkey's own pixels become others, and most of them do: it was of one colour
    after = pixels()
    changed = (abs(after - before).max(axis=-1) > 3)[:, :sidebar()[1].x - 60]
    told["drawn"] = int(changed.sum())
    told["colours"] = len({tuple(colour) for colour in after[:, :changed.shape[1]][changed]})
    path = monkey.rsibr.map_set
    with bpy.context.temp_override(window=window()):
        bpy.ops.ed.undo()
        told["undone"] = bpy.context.object.rsibr.map_set
        bpy.ops.ed.redo()
        told["redone"] = bpy.context.object.rsibr.map_set == path
    bpy.context.object.rsibr.map_set = ""
    told["again"] = bake()
    told["bakes again"], told["taken"] = len(session().bakes.bakes), bpy.context.object.rsibr.map_set == path
"""

CANCEL = """
def scenario(told):
    with bpy.context.temp_override(window=window()):
        bpy.ops.wm.save_as_mainfile(filepath="/job/artist.blend")
    chosen, cube = settings(), bpy.data.objects["Cube"]
    bpy.ops.ed.undo_push(message="Changed")
    hold(3)
    told["baked"] = bake()
    told["file"] = bpy.data.filepath, bpy.data.is_dirty
    first = session().bakes.bakes[0]
    yield from done(lambda: finished_views(first) == 3)
    told["cancelled"] = list(bpy.ops.rsibr.cancel_bake(number=0))
    told["state"], told["process"] = str(first.state), first._process.poll() is not None
    told["kept"] = finished_views(first)
    let_go()
    yield from done()
    told["assigned"] = cube.rsibr.map_set
    told["forgotten"] = list(bpy.ops.rsibr.cancel_bake(number=0)), len(session().bakes.bakes)
    bake()
    second = session().bakes.bakes[0]
    yield from done(lambda: second.progress is not None and second.progress.done >= 3)
    yield from done()
    told["warnings"] = list(second.warnings)
    told["then"] = str(second.state), second.message
    told["relative"] = cube.rsibr.map_set
    told["folder"] = sorted(os.listdir("/job/rsibr"))
"""

FAILURES = """
def scenario(told):
    settings()
    cube = bpy.data.objects["Cube"]
    hold(0)
    bake()
    killed = session().bakes.bakes[0]
    yield from done(lambda: killed.progress is not None)
    os.kill(killed._process.pid, signal.SIGKILL)
    yield from done()
    let_go()
    told["killed"] = str(killed.state), killed.message
    told["assigned"] = cube.rsibr.map_set
    bpy.data.worlds.remove(bpy.context.scene.world)
    bpy.context.scene.rsibr_bake.light = "WORLD"
    told["without a world"] = bpy.ops.rsibr.bake.poll()
    bpy.context.scene.rsibr_bake.light = "STUDIO"
    bake()
    gone = session().bakes.bakes[0]
    bpy.data.objects.remove(cube)
    yield from done()
    told["object gone"] = str(gone.state), gone.message
    told["others"] = [each.name for each in bpy.data.objects if each.rsibr.map_set]
"""

DISABLE = """
def scenario(told):
    import addon_utils
    settings()
    hold(1)
    bake()
    bakes = session().bakes
    running = bakes.bakes[0]
    yield from done(lambda: finished_views(running) == 1)
    addon_utils.disable(ROOT)
    told["ended"], told["state"] = running._process.poll() is not None, str(running.state)
    told["folder"] = os.path.exists(running.command[-4])
    told["timer"] = bpy.app.timers.is_registered(background._look)
    told["queue"] = len(bakes.bakes)
    yield
"""


def test_from_the_button_to_the_preview(told: Told) -> None:
    answer = told(PRELUDE + WAY)
    assert answer.pop("drawn") > 3000
    assert answer.pop("colours") > 20
    assert answer.pop("map set").startswith("mip-chain-in-forest-")
    assert answer == {
        "pressed": True,
        "bakes": 1,
        "file": "",
        "state": ["done"],
        "message": [""],
        "left behind": [],
        "undone": "",
        "redone": True,
        "again": ["FINISHED"],
        "bakes again": 1,
        "taken": True,
    }


def test_a_cancelled_bake_goes_on_when_it_is_baked_again(told: Told, job: Path) -> None:
    answer = told(PRELUDE + CANCEL)
    relative = answer.pop("relative")
    assert relative.startswith("//rsibr/material-in-forest-")
    assert (job / relative.removeprefix("//")).is_file()
    assert answer == {
        "baked": ["FINISHED"],
        "file": ["/job/artist.blend", True],
        "cancelled": ["FINISHED"],
        "state": "cancelled",
        "process": True,
        "kept": 3,
        "assigned": "",
        "forgotten": [["FINISHED"], 0],
        "warnings": [],
        "then": ["done", ""],
        "folder": [relative.removeprefix("//rsibr/")],
    }


def test_what_goes_wrong_is_told_and_nothing_is_assigned(told: Told) -> None:
    answer = told(PRELUDE + FAILURES)
    state, message = answer.pop("killed")
    assert state == "failed"
    assert message.startswith("The background Blender ended with code -9 and no result")
    assert answer == {
        "assigned": "",
        "without a world": False,
        "object gone": ["done", ""],
        "others": [],
    }


def test_disabling_the_extension_ends_its_bakes(told: Told) -> None:
    assert told(PRELUDE + DISABLE) == {
        "ended": True,
        "state": "cancelled",
        "folder": False,
        "timer": False,
        "queue": 0,
    }
