"""Two Blenders bake the same: one works, the other waits, and each has the whole map set in the end."""

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from rsibr.tests.gui.panel import PRELUDE

Told = Callable[[str], dict]

OTHER = """
bake_order = importlib.import_module(ROOT + ".rsibr_addon.tasks.queue.bake_request")
map_sets = importlib.import_module(ROOT + ".rsibr_addon.files.map_set")

def another_blender(cube):
    # A bake of the same that is in another Blender's queue
    order = bake_order.request_for(bpy.context.scene.rsibr_bake, bpy.context.scene, cube)
    output = bake_order.output_for(order, bpy.context.scene, cube)
    queue = type(session().bakes)()
    queue.add(bake_order.bake_of(order, bpy.context.scene, [cube], output))
    return queue

def ended(queue):
    while queue.busy:
        queue.update()
        yield
    return queue.bakes[0]

def told_of(bake):
    return [str(bake.state), bake.message]
"""

LOCKED = """
def scenario(told):
    settings()
    cube = bpy.data.objects["Cube"]
    hold(1)
    others = another_blender(cube)
    yield from done(lambda: finished_views(others.bakes[0]) == 1)
    bake()
    ours = session().bakes.bakes[0]
    yield from done(lambda: ours.progress and ours.progress.what.startswith("waiting"))
    told["before"] = cube.rsibr.map_set
    let_go()
    told["other's"] = told_of((yield from ended(others)))
    yield from done()
    told["ours"], told["assigned"] = told_of(ours), os.path.basename(cube.rsibr.map_set)
    told["files"] = os.listdir(others.bakes[0].output.parent)
"""

AT_ONCE = """
def scenario(told):
    settings().kind = "mip_chain"
    cube = bpy.data.objects["Cube"]
    others = another_blender(cube)
    bake()
    yield from done()
    other = yield from ended(others)
    told["ours"], told["other's"] = told_of(session().bakes.bakes[0]), told_of(other)
    told["output"], told["assigned"] = str(other.output), os.path.basename(cube.rsibr.map_set)
    told["whole"] = map_sets.is_whole_map_set(other.output)
    told["files"] = os.listdir(other.output.parent)
"""


@pytest.fixture(autouse=True)
def _nothing_baked(job: Path) -> None:
    for folder in job.glob("user/extensions/.user/*/rsibr/baked"):
        shutil.rmtree(folder)


def test_one_of_two_captures_waits_for_the_other(told: Told) -> None:
    answer = told(PRELUDE + OTHER + LOCKED)
    assert answer["before"] == ""
    assert answer["ours"] == answer["other's"] == ["done", ""]
    assert [answer["assigned"]] == answer["files"]


def test_of_two_at_once_both_have_the_file(told: Told) -> None:
    answer = told(PRELUDE + OTHER + AT_ONCE)
    assert answer["ours"] == answer["other's"] == ["done", ""]
    assert answer["whole"]
    assert [answer["assigned"]] == answer["files"] == [Path(answer["output"]).name]
