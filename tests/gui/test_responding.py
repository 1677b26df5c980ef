"""Blender goes on drawing while a bake goes on beside it."""

import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from rsibr.tests.flat_capture import write_flat_capture
from rsibr.tests.gui.test_panel import PRELUDE

type Told = Callable[[str], dict]

LONGER = 0.2
"""[s] that a gap between redraws may be longer than those of an idle window."""

SCENARIO = """
MOST = 40.0

previews = importlib.import_module(ROOT + ".rsibr_addon.tasks.viewport").previews

def redraws(until, begin=lambda: None):
    # When the viewport was drawn, ten times a second if it can be
    times = [time.monotonic()]
    handle = bpy.types.SpaceView3D.draw_handler_add(
        lambda: times.append(time.monotonic()), (), "WINDOW", "POST_PIXEL"
    )
    begin()
    while not until():
        if time.monotonic() - times[-1] > 0.1:
            region(view()).tag_redraw()
        yield
    bpy.types.SpaceView3D.draw_handler_remove(handle, "WINDOW")
    return times

def scenario(told):
    # A preview is there already, so that programs and the display's table are
    bare(view())
    settings()
    cube = bpy.data.objects["Cube"]
    other = bpy.data.objects.new("Other", cube.data.copy())
    bpy.context.collection.objects.link(other)
    other.location = (0.0, 2.5, 0.0)
    other.rsibr.map_set = "/job/flat.rsibr.exr"
    yield from drawn()
    end = time.monotonic() + MOST
    baking = yield from redraws(lambda: previews.kind(cube) or time.monotonic() > end, bake)
    yield from done(lambda: previews.kind(cube))
    told["state"] = [str(each.state) for each in background.queue.bakes]
    end = time.monotonic() + baking[-1] - baking[0]
    idle = yield from redraws(lambda: time.monotonic() > end)
    told["baking"], told["idle"] = baking, idle
"""


@pytest.fixture(autouse=True)
def _flat(job: Path) -> None:
    write_flat_capture(job / "flat.rsibr.exr", (0.5, 0.0, 0.5))
    for folder in job.glob("user/extensions/.user/*/rsibr/baked"):
        shutil.rmtree(folder)


def test_gaps_between_redraws_stay_short_while_a_bake_goes_on(told: Told) -> None:
    """From the button until the result is shown, at most 40 s; then as long with nothing to do."""
    answer = told(PRELUDE + SCENARIO)
    assert answer["state"] == ["done"]
    baking, idle = np.diff(answer["baking"]), np.diff(answer["idle"])
    assert min(len(baking), len(idle)) > 10
    assert baking.max() <= idle.max() + LONGER
