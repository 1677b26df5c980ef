"""Capturing from Blender's window: step by step, ended by Escape, gone on with, and no trace of it."""

import json
import subprocess
from collections.abc import Callable

SCRIPT = """
import json, os, time, traceback
import bpy
from bl_ext.user_default.rsibr.rsibr_addon.tasks import environments

environments.WORLD_HEIGHT = 32
OUTPUT = "/job/captured.rsibr.exr"
told = {}


def invoke():
    window = bpy.context.window_manager.windows[0]
    with bpy.context.temp_override(window=window):
        return list(bpy.ops.rsibr.capture_views("INVOKE_DEFAULT", filepath=OUTPUT, size=16, samples=4))


def finished_views():
    folder = OUTPUT + ".partial"
    return sum(name.startswith("view") for name in os.listdir(folder)) if os.path.isdir(folder) else 0


def scenario():
    # Each yield lets Blender handle its events.
    window = bpy.context.window_manager.windows[0]
    cube = bpy.data.objects["Cube"]
    bpy.ops.ed.undo_push(message="before")
    cube.location.x = 5.0
    bpy.ops.ed.undo_push(message="moved")
    told["invoked"] = invoke()
    while finished_views() < 3:
        yield
    told["scenes"] = len(bpy.data.scenes)
    window.event_simulate(type="ESC", value="PRESS")
    while window.modal_operators:
        yield
    told["kept"], told["whole"] = finished_views(), os.path.exists(OUTPUT)
    invoke()
    while window.modal_operators:
        yield
    told["whole in the end"] = os.path.exists(OUTPUT)
    told["kept in the end"] = os.path.exists(OUTPUT + ".partial")
    with bpy.context.temp_override(window=window):
        bpy.ops.ed.undo()
    told["undone to"] = bpy.data.objects["Cube"].location.x


def tick():
    try:
        next(steps)
    except BaseException as end:
        if not isinstance(end, StopIteration):
            told["error"] = traceback.format_exc()
        print("TOLD", json.dumps(told), flush=True)
        os._exit(0)
    if time.monotonic() > deadline:
        os._exit(1)
    return 0.05


steps, deadline = scenario(), time.monotonic() + 240.0
bpy.app.timers.register(tick, first_interval=1.0)
"""


def test_a_capture_can_be_ended_and_gone_on_with(
    blender: Callable[..., subprocess.CompletedProcess[str]],
) -> None:
    process = blender("--window", "--enable-event-simulate", "--python-expr", SCRIPT)
    lines = [line for line in process.stdout.splitlines() if line.startswith("TOLD ")]
    assert lines, process.stdout + process.stderr
    told = json.loads(lines[0].removeprefix("TOLD "))
    kept = told.pop("kept")
    assert told == {
        "invoked": ["RUNNING_MODAL"],
        "scenes": 1,
        "whole": False,
        "whole in the end": True,
        "kept in the end": False,
        "undone to": 0.0,  # the move was the last thing to undo: captures are none
    }
    assert 3 <= kept < 12
