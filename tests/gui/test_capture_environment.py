"""Capturing light from Blender's window: step by step, ended by Escape, and whole."""

import json
import subprocess
from collections.abc import Callable

SCRIPT = """
import json, os, time, traceback
import bpy

OUTPUT = "/job/light.exr"
told = {}


def invoke():
    window = bpy.context.window_manager.windows[0]
    with bpy.context.temp_override(window=window):
        return list(
            bpy.ops.rsibr.capture_environment("INVOKE_DEFAULT", filepath=OUTPUT, size=32, samples=16)
        )


def scenario():
    # Each yield lets Blender handle its events.
    window = bpy.context.window_manager.windows[0]
    datablocks = len(bpy.data.all_ids)
    told["invoked"] = invoke()
    yield
    told["more datablocks between steps"] = len(bpy.data.all_ids) - datablocks
    window.event_simulate(type="ESC", value="PRESS")
    while window.modal_operators:
        yield
    told["written"] = os.path.exists(OUTPUT)
    invoke()
    while window.modal_operators:
        yield
    told["written in the end"] = os.path.exists(OUTPUT)
    told["loaded"] = tuple(bpy.data.images["light.exr"].size)


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
    return 0.02


steps, deadline = scenario(), time.monotonic() + 240.0
bpy.app.timers.register(tick, first_interval=1.0)
"""


def test_light_is_captured_or_not_at_all(blender: Callable[..., subprocess.CompletedProcess[str]]) -> None:
    process = blender("--window", "--enable-event-simulate", "--python-expr", SCRIPT)
    lines = [line for line in process.stdout.splitlines() if line.startswith("TOLD ")]
    assert lines, process.stdout + process.stderr
    assert json.loads(lines[0].removeprefix("TOLD ")) == {
        "invoked": ["RUNNING_MODAL"],
        "more datablocks between steps": 0,
        "written": False,
        "written in the end": True,
        "loaded": [32, 16],
    }
