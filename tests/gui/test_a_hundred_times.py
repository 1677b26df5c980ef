"""A hundred times enabled, a hundred files loaded: nothing is left over, in Blender's window."""

from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from statistics import median

import pytest
from rsibr.tests.flat_capture import write_flat_capture

Told = Callable[[str], dict]

GROWTH = 2.5
"""[MB] of memory in ten times: the median of what the 3rd to the 10th ten add, as a leak adds in each.

Of what a preview has on the GPU, here in the same memory, light from faces of 32 pixels is the least: 0.5 MB,
so 5 in ten times. Without a leak 0 to 0.1 were seen; now and then an allocator takes 20 more at once.
"""

PRELUDE = """
import addon_utils, gc, gpu, threading

DEVICE = tuple(kind for name, kind in vars(gpu.types).items() if name.startswith("GPU"))

def on_gpu():
    # How many objects of Blender's graphics Python holds: they are in no list, but whatever holds them is
    gc.collect()
    holders = gc.get_objects()
    found = {id(each): each for holder in holders for each in gc.get_referents(holder)}
    return dict(Counter(type(each).__name__ for each in found.values() if isinstance(each, DEVICE)))

def traces():
    # All by which the extension could be known while it is disabled
    def ours(functions):
        return [function.__qualname__ for function in functions if "rsibr" in function.__module__]

    kinds = [getattr(bpy.types, name) for name in dir(bpy.types)]
    lists = [getattr(bpy.app.handlers, name) for name in dir(bpy.app.handlers)]
    timers = [
        function
        for name in (".rsibr_addon.ui.viewport_handlers", ".operators.background")
        for function in vars(importlib.import_module(ROOT + name)).values()
        if callable(function) and bpy.app.timers.is_registered(function)
    ]
    return [
        *(name for name in dir(bpy.types) if name.lower().startswith("rsibr")),
        *(f"{kind.__name__}.{name}" for kind in kinds for name in dir(kind) if name.startswith("rsibr")),
        *(name for functions in lists if isinstance(functions, list) for name in ours(functions)),
        *(name for kind in kinds for name in ours(getattr(getattr(kind, "draw", None), "_draw_funcs", ()))),
        *ours(timers),
        *dir(bpy.ops.rsibr),
        *map(str, on_gpu().items()),
        *(f"process {number}" for number in children()),
        *(thread.name for thread in threading.enumerate() if thread is not threading.main_thread()),
    ]

def children():
    return [number for task in os.listdir("/proc/self/task")
            for number in open(f"/proc/self/task/{task}/children").read().split()]

def megabytes():
    return int(open("/proc/self/statm").read().split()[1]) * os.sysconf("SC_PAGESIZE") / 1e6

def lit():
    # A cube that a map set shades, and another in live light, and the panel that tells of the first
    bare(view())
    cube = bpy.data.objects["Cube"]
    cube.rsibr.map_set = "/job/flat.rsibr.exr"
    other = bpy.data.objects.new("Other", cube.data.copy())
    bpy.context.collection.objects.link(other)
    other.location = (0.0, 2.5, 0.0)
    other.rsibr.live.on, other.rsibr.live.size, other.rsibr.live.budget = True, "32", 1000
    view().spaces.active.show_region_ui = True
    yield from drawn()
    next(part for part in view().regions if part.type == "UI").active_panel_category = "RSIBR"
    yield from drawn()

def hundred(told, once):
    # Every tenth time all is drawn; else the window is, but is not waited for
    told["memory"] = []
    for number in range(1, 101):
        once()
        yield from drawn() if number % 10 == 0 else iter([None])
        told["memory"].append(megabytes())
        if number in (10, 100):
            told[f"on the device, {number}"] = on_gpu()
    faults = session().previews.faults
    told["trouble"] = [faults.trouble, *map(faults.message, bpy.data.objects)]

def drawn_by():
    # How often a viewport's draw calls us
    calls, draw = [], session().previews.draw
    session().previews.draw = lambda view: (calls.append(0), draw(view))[1]
    before = draws.total()
    yield from drawn()
    del session().previews.draw
    return len(calls) / (draws.total() - before)
"""

ENABLED = """
def scenario(told):
    addon_utils.disable(ROOT)
    told["never drawn"] = traces()
    addon_utils.enable(ROOT)
    yield from lit()

    def once():
        addon_utils.disable(ROOT)
        addon_utils.enable(ROOT)

    yield from hundred(told, once)
    told["draws"] = yield from drawn_by()
    bpy.ops.rsibr.bake("INVOKE_DEFAULT")
    told["bakes"] = len(children())
    addon_utils.disable(ROOT)
    yield
    told["traces"] = traces()
"""

LOADED = """
def scenario(told):
    yield from lit()
    with bpy.context.temp_override(window=window()):
        bpy.ops.wm.save_as_mainfile(filepath="/job/lit.blend")

    def once():
        with bpy.context.temp_override(window=window()):
            bpy.ops.wm.open_mainfile(filepath="/job/lit.blend")

    yield from hundred(told, once)
    told["draws"] = yield from drawn_by()
    with bpy.context.temp_override(window=window()):
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    told["of an empty file"] = {name: many for name, many in on_gpu().items() if name != "GPUShader"}
    addon_utils.disable(ROOT)
    told["traces"] = traces()
"""


@pytest.fixture(autouse=True)
def _flat(job: Path) -> None:
    write_flat_capture(job / "flat.rsibr.exr", (0.5, 0.0, 0.5))


def check(answer: dict) -> None:
    assert answer["on the device, 10"]["GPUTexture"] > 5
    assert answer["on the device, 100"] == answer["on the device, 10"]
    assert answer["draws"] == 1
    assert set(answer["trouble"]) == {None}
    tens = [median(answer["memory"][start : start + 10]) for start in range(10, 100, 10)]
    assert median(after - before for before, after in pairwise(tens)) < GROWTH
    assert answer["traces"] == []


def test_a_hundred_times_enabled(told: Told) -> None:
    answer = told(PRELUDE + ENABLED)
    check(answer)
    assert answer["never drawn"] == []
    assert answer["bakes"] == 1


def test_a_hundred_files_loaded(told: Told) -> None:
    answer = told(PRELUDE + LOADED)
    check(answer)
    assert answer["of an empty file"] == {}
