"""Making light of photographs through Blender's file browser."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.files.radiance_pictures import read_radiance, write_radiance

Told = Callable[[str], dict]

RADIANCE = np.geomspace(0.02, 8.0, 600).reshape(20, 30)[..., None] * np.array([1.0, 0.5, 0.8])
TIMES = (0.1, 0.5, 2.0)

SCENARIO = """
bpy.context.preferences.view.filebrowser_display_type = "WINDOW"

def browser():
    windows = bpy.context.window_manager.windows
    return windows[1] if len(windows) > 1 else None

def browse(operator, **properties):
    with bpy.context.temp_override(window=window()):
        told = list(operator("INVOKE_DEFAULT", **properties))
    while browser() is None or not browser().screen.areas[0].spaces.active.params:
        yield
    return told

def within_browser():
    area = browser().screen.areas[0]
    return bpy.context.temp_override(window=browser(), area=area, region=region(area))

def chosen():
    # How many files are, when all are that Blender has listed so far; None before it has any
    with within_browser():
        bpy.ops.file.select_all(action="SELECT")
        return len(bpy.context.selected_files or ())

def press(operator, **properties):
    with within_browser():
        operator(**properties)
    while browser() is not None:
        yield

def scenario(told):
    yield
    told["opened"] = yield from browse(bpy.ops.rsibr.merge_brackets, directory="/job/bracket/")
    yield from press(bpy.ops.file.cancel)
    told["written after cancelling"] = os.path.exists("/job/bracket/a-light.exr")
    yield from browse(
        bpy.ops.rsibr.merge_brackets, directory="/job/bracket/", times="0.1 0.5 2", align=False
    )
    while chosen() < 3:
        yield
    with steps_held() as steps:
        yield from press(bpy.ops.file.execute)
        while "a-light.exr" not in bpy.data.images:
            yield
    told["steps"] = len(steps), sorted(set(steps))
    told["loaded"] = tuple(bpy.data.images["a-light.exr"].size)
"""


@pytest.fixture
def bracket(job: Path) -> Path:
    """Photographs a, b and c in a folder of their own, which Blender sees as /job/bracket."""
    folder = job / "bracket"
    folder.mkdir()
    for name, time in zip("abc", TIMES, strict=True):
        write_radiance(folder / f"{name}.exr", np.minimum(RADIANCE * time, 1.0))
    return folder


def test_a_bracket_is_chosen_in_the_browser(told: Told, bracket: Path) -> None:
    answer = told(SCENARIO)
    steps, operators = answer.pop("steps")
    # So that Blender goes on meanwhile
    assert steps > len(TIMES)
    assert operators == ["RSIBR_OT_merge_brackets"]
    assert answer == {
        "opened": ["RUNNING_MODAL"],
        "written after cancelling": False,
        "loaded": [30, 20],
    }
    np.testing.assert_allclose(read_radiance(bracket / "a-light.exr"), RADIANCE, rtol=1e-6)  # float32
