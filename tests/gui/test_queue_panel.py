"""The queue of bakes in the panel, as Blender's window draws it."""

from collections.abc import Callable

from rsibr.tests.gui.panel import PRELUDE

ENDED = """
queue = importlib.import_module(ROOT + ".rsibr_addon.tasks.queue.background")
request = importlib.import_module(ROOT + ".rsibr_addon.tasks.queue.bake_request")

def look():
    area, region = sidebar()
    region.tag_redraw()
    for _ in range(5):
        yield from drawn()
    part = xshot.grab()[::-1][region.y : region.y + region.height, region.x : region.x + region.width]
    return part.astype(int)

def scenario(told):
    chosen = settings()
    chosen.light = "WORLD"  # of the fewest buttons, so that the queue is in sight
    yield from tab()
    yield from look()
    nothing = yield from look()
    ended = request.ObjectBake(title="Cube: paint", output=pathlib.Path("/job/a.rsibr.exr"), command=())
    ended.state, ended.warnings = queue.State.DONE, ["Short."]
    session().bakes.bakes.append(ended)
    short = yield from look()
    ended.warnings = ["A sentence that takes several lines of the panel, were it shown. " * 4] * 3
    long = yield from look()
    told["seen"] = bool((nothing != short).any())
    told["by its warnings"] = bool((short != long).any())
"""


def test_an_ended_bake_takes_as_much_room_whatever_its_warnings(told: Callable[[str], dict]) -> None:
    assert told(PRELUDE + ENDED) == {"seen": True, "by its warnings": False}
