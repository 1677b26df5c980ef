"""Many objects, many edits, a slow disk: a redraw reads no file; its work and memory do not run away."""

import gc
import os
import sys
import time
import tracemalloc
from collections.abc import Callable
from pathlib import Path
from typing import Any

import bpy
import gpu
import pytest
from mathutils import Matrix
from rsibr.rsibr_addon.core.at_once import AtOnce
from rsibr.rsibr_addon.files.map_set import write_map_set
from rsibr.rsibr_addon.host.map_sets import use_map_set
from rsibr.rsibr_addon.host.visible_surfaces import View
from rsibr.rsibr_addon.tasks.methods import live_materials
from rsibr.rsibr_addon.tasks.methods.latest_request_worker import LatestRequestWorker
from rsibr.rsibr_addon.tasks.methods.live_materials import LiveFits
from rsibr.rsibr_addon.tasks.viewport.previews import Previews
from rsibr.tests.faults.small_map_sets import map_sets

SIZE = 32
TOOL = 4
"""A number for `sys.monitoring` that nobody else has."""

EDITS = 10_000 if "RSIBR_MOMENTS" in os.environ else 100

Draw = Callable[[Previews], None]

_opened: list[str] | None = None
"""Files that Python opens, while someone wants to know."""


def _heard(event: str, arguments: tuple[Any, ...]) -> None:
    if _opened is not None and event == "open":
        _opened.append(str(arguments[0]))


sys.addaudithook(_heard)  # no way leads back


@pytest.fixture
def draw(view: View) -> Draw:
    """Draw a frame; of the first one, the display's colours are learnt."""
    target = gpu.types.GPUOffScreen(SIZE, SIZE)

    def frame(previews: Previews) -> None:
        with target.bind(), gpu.matrix.push_pop(), gpu.matrix.push_pop_projection():
            gpu.matrix.load_matrix(Matrix.Identity(4))
            gpu.matrix.load_projection_matrix(Matrix.Diagonal((0.5, 0.5, -0.02, 1.0)))
            with previews.faults.guarded():
                if not previews.draw(view):
                    previews.add_display(view.scene)
                    previews.draw(view)
        assert previews.faults.trouble is None

    return frame


def shade(item: bpy.types.Object, path: Path) -> None:
    item.rsibr.show = True
    use_map_set(item.rsibr, str(path))


@pytest.fixture(params=range(5), ids=lambda number: map_sets()[number].kind)
def path(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    """A map set, of each kind."""
    map_set = map_sets()[request.param]
    path = tmp_path / f"{map_set.kind}.rsibr.exr"
    write_map_set(path, map_set)
    return path


@pytest.mark.filterwarnings("ignore:Maps of 4 texels blur")
def test_a_redraw_reads_no_file(path: Path, draw: Draw, monkeypatch: pytest.MonkeyPatch) -> None:
    global _opened
    shade(bpy.context.object, path)
    previews = Previews(LiveFits(), AtOnce())
    draw(previews)
    assert previews.faults.message(bpy.context.object) is None
    touched: list[str] = []
    stat = os.stat

    def told(name: Any, *arguments: Any, **named: Any) -> os.stat_result:
        touched.append(os.fspath(name))
        return stat(name, *arguments, **named)

    monkeypatch.setattr(os, "stat", told)
    _opened = touched
    try:
        draw(previews)
        bpy.context.object.location.x += 0.1
        bpy.context.view_layer.update()
        previews.scene_changed()
        draw(previews)
    finally:
        _opened = None
    assert touched == []


def test_a_warning_of_the_thread_reaches_the_panel(tmp_path: Path, draw: Draw) -> None:
    (bank,) = (each for each in map_sets() if each.kind == "kernel_bank")
    write_map_set(tmp_path / "bank.rsibr.exr", bank)
    item, worker = bpy.context.object, LatestRequestWorker()
    shade(item, tmp_path / "bank.rsibr.exr")
    previews = Previews(LiveFits(worker), AtOnce())
    try:
        draw(previews)
        while worker.is_busy:
            draw(previews)
    finally:
        worker.close()
    (message,) = previews.messages(item)
    assert message.startswith("Maps of 4 texels blur")


def calls_in(work: Callable[[], None]) -> int:
    """How many calls Python makes."""
    count = 0

    def called(*_: Any) -> None:
        nonlocal count
        count += 1

    sys.monitoring.use_tool_id(TOOL, "load")
    sys.monitoring.register_callback(TOOL, sys.monitoring.events.CALL, called)
    sys.monitoring.set_events(TOOL, sys.monitoring.events.CALL)
    try:
        work()
    finally:
        sys.monitoring.set_events(TOOL, 0)
        sys.monitoring.free_tool_id(TOOL)
    return count


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:Maps of 4 texels blur")
def test_work_grows_as_the_number_of_objects(path: Path, draw: Draw) -> None:
    mesh = bpy.context.object.data
    bpy.data.objects.remove(bpy.context.object)
    redraws, changes, previews = {}, {}, Previews(LiveFits(), AtOnce())
    for count in (100, 1000):
        while len(bpy.context.collection.objects) < count + 2:  # a camera and a lamp
            item = bpy.data.objects.new("Cube", mesh)
            bpy.context.collection.objects.link(item)
            shade(item, path)
        bpy.context.view_layer.update()
        previews.scene_changed()
        draw(previews)
        redraws[count] = calls_in(lambda: draw(previews))
        previews.scene_changed()
        changes[count] = calls_in(lambda: draw(previews))
    for told in (redraws, changes):
        assert told[1000] < 10 * told[100]
        # What an object takes is a few hundred calls, which take less than a millisecond
        assert told[1000] - told[100] < 900 * 300


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:Maps of 4 texels blur")
def test_memory_stays_level_in_a_day_of_edits(
    path: Path, draw: Draw, monkeypatch: pytest.MonkeyPatch
) -> None:
    item, worker, levels = bpy.context.object, LatestRequestWorker(), []
    previews = Previews(LiveFits(worker), AtOnce())
    monkeypatch.setattr(live_materials, "FITS_KEPT", 8)  # else the level rises for a long time
    shade(item, path)
    tracemalloc.start()
    try:
        # A kernel bank's material is fitted again for each edit, which tracing makes slow
        edits = 5 if EDITS == 100 and path.name.startswith("kernel_bank") else EDITS
        for number in range(edits + 1):
            edit(item, path.name.partition(".")[0], number / edits)
            bpy.context.view_layer.update()
            previews.scene_changed()
            draw(previews)
            if number % (edits // 5) == 0:
                while worker.is_busy:
                    draw(previews)
                    time.sleep(0.02)  # else drawing keeps the thread from its work
                assert previews.faults.message(item) is None
                gc.collect()
                levels.append(tracemalloc.get_traced_memory()[0])
    finally:
        tracemalloc.stop()
        worker.close()
    # The first ones are those of a beginning
    assert levels[-1] - levels[2] < 200_000


def edit(item: bpy.types.Object, kind: str, value: float) -> None:
    """Change what an artist would, to a value from 0 to 1: the look where it has sliders, and the place."""
    group = getattr(item.rsibr, kind, None)
    for name in ("w_diffuse", "roughness", "bias"):
        if hasattr(group, name):
            setattr(group, name, value)
    if kind == "kernel_bank":
        group.lobe_count = 1
        group.brdf = f"ggx:alpha={0.5 + 0.5 * value:.6f},metal=gold"
    item.location.x = value
