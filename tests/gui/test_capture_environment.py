"""Capturing light from Blender's window: step by step, ended by Escape, and whole."""

from collections.abc import Callable

SCENARIO = """
OUTPUT = "/job/light.exr"

def invoke():
    with bpy.context.temp_override(window=window()):
        return list(
            bpy.ops.rsibr.capture_environment("INVOKE_DEFAULT", filepath=OUTPUT, size=32, samples=16)
        )

def scenario(told):
    datablocks = len(bpy.data.all_ids)
    with steps_held(1) as steps:
        told["invoked"] = invoke()
        while not steps:
            yield
        told["more datablocks between steps"] = len(bpy.data.all_ids) - datablocks
        window().event_simulate(type="ESC", value="PRESS")
        while window().modal_operators:
            yield
    told["written"] = os.path.exists(OUTPUT)
    invoke()
    while window().modal_operators:
        yield
    told["written in the end"] = os.path.exists(OUTPUT)
    told["loaded"] = tuple(bpy.data.images["light.exr"].size)
"""


def test_light_is_captured_or_not_at_all(told: Callable[[str], dict]) -> None:
    assert told(SCENARIO) == {
        "invoked": ["RUNNING_MODAL"],
        "more datablocks between steps": 0,
        "written": False,
        "written in the end": True,
        "loaded": [32, 16],
    }
