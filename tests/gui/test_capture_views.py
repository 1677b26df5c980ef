"""Capturing from Blender's window: step by step, ended by Escape, gone on with, and no trace of it."""

from collections.abc import Callable

SCENARIO = """
importlib.import_module(ROOT + ".rsibr_addon.tasks.light.environments").WORLD_HEIGHT = 32
OUTPUT = "/job/captured.rsibr.exr"

def invoke():
    with bpy.context.temp_override(window=window()):
        return list(bpy.ops.rsibr.bake_radiance_views("INVOKE_DEFAULT", filepath=OUTPUT, size=16, samples=4))

def finished_views():
    folder = OUTPUT + ".partial"
    return sum(name.startswith("view") for name in os.listdir(folder)) if os.path.isdir(folder) else 0

def scenario(told):
    cube = bpy.data.objects["Cube"]
    bpy.ops.ed.undo_push(message="before")
    cube.location.x = 5.0
    bpy.ops.ed.undo_push(message="moved")
    # Two steps, and one for each view
    with steps_held(5) as steps:
        told["invoked"] = invoke()
        while len(steps) < 5:
            yield
        told["scenes"] = len(bpy.data.scenes)
        window().event_simulate(type="ESC", value="PRESS")
        while window().modal_operators:
            yield
    told["kept"], told["whole"] = finished_views(), os.path.exists(OUTPUT)
    invoke()
    while window().modal_operators:
        yield
    told["whole in the end"] = os.path.exists(OUTPUT)
    told["kept in the end"] = os.path.exists(OUTPUT + ".partial")
    with bpy.context.temp_override(window=window()):
        bpy.ops.ed.undo()
    told["undone to"] = bpy.data.objects["Cube"].location.x
"""


def test_a_capture_can_be_ended_and_gone_on_with(told: Callable[[str], dict]) -> None:
    assert told(SCENARIO) == {
        "invoked": ["RUNNING_MODAL"],
        "kept": 3,
        "scenes": 1,
        "whole": False,
        "whole in the end": True,
        "kept in the end": False,
        "undone to": 0.0,  # the move was the last thing to undo: captures are none
    }
