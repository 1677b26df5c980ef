"""A map set comes aside: the window goes on with what it has, however slow the disk, whatever goes wrong."""

import sys
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import bpy
import gpu
import numpy as np
import pytest
from mathutils import Matrix
from rsibr.rsibr_addon.files.map_set import MapSet, write_map_set
from rsibr.rsibr_addon.host.map_sets import use_map_set
from rsibr.rsibr_addon.host.visible_surfaces import View
from rsibr.rsibr_addon.tasks.methods.live_materials import LiveFits
from rsibr.rsibr_addon.tasks.viewport import map_sets as viewport_map_sets
from rsibr.rsibr_addon.tasks.viewport.previews import Previews
from rsibr.tests.faults.small_map_sets import map_sets
from rsibr.tests.glsl.frames import frame_of

SIZE = 32
KINDS = ("radiance_views", "lobe_stack", "reflection_tables", "mip_chain")

Draw = Callable[[Previews], np.ndarray]

_opened: list[str] | None = None
"""Files that the thread which draws opens, while someone wants to know."""

_drawing = threading.get_ident()


def _heard(event: str, arguments: tuple[Any, ...]) -> None:
    if _opened is not None and event == "open" and threading.get_ident() == _drawing:
        _opened.append(str(arguments[0]))


sys.addaudithook(_heard)  # no way leads back


class SlowDisk(ThreadPoolExecutor):
    """A thread whose work waits until it is let go."""

    def __init__(self) -> None:
        super().__init__(1)
        self.may_go = threading.Event()

    def submit(self, function: Callable[..., Any], /, *given: Any, **named: Any) -> Any:
        """Have it done, later."""

        def work() -> Any:
            assert self.may_go.wait(60.0)
            return function(*given, **named)

        return super().submit(work)

    def rest(self) -> None:
        """Let all that was asked for be done."""
        self.may_go.set()
        super().submit(int).result()


@pytest.fixture
def disk() -> Iterator[SlowDisk]:
    """A slow one."""
    with SlowDisk() as slow:
        yield slow
        slow.may_go.set()


@pytest.fixture
def previews(disk: SlowDisk) -> Previews:
    """Those of map sets on a slow disk."""
    return Previews(LiveFits(), disk)


@pytest.fixture
def draw(view: View) -> Draw:
    """Draw a frame of the cube, and read it, shape (SIZE, SIZE, 4)."""
    target = gpu.types.GPUOffScreen(SIZE, SIZE, format="RGBA32F")
    return lambda previews: frame_of(previews, view, target, Matrix.Identity(4))


@pytest.fixture
def written(tmp_path: Path) -> dict[str, MapSet]:
    """Path -> a map set of each kind whose looks need no thread."""
    there = {}
    for map_set in map_sets():
        if map_set.kind in KINDS:
            path = tmp_path / f"{map_set.kind}.rsibr.exr"
            write_map_set(path, map_set)
            there[str(path)] = map_set
    return there


@contextmanager
def opened_by_the_window() -> Iterator[list[str]]:
    """Files that are opened within, but by threads."""
    global _opened
    _opened = opened = list[str]()
    try:
        yield opened
    finally:
        _opened = None


def shade(path: str) -> bpy.types.Object:
    """Have the cube shaded from a file."""
    item = bpy.context.object
    item.rsibr.show = True
    use_map_set(item.rsibr, path)
    bpy.context.view_layer.update()
    return item


def test_until_another_is_there_the_one_before_is_shown(
    written: dict[str, MapSet], draw: Draw, previews: Previews, disk: SlowDisk
) -> None:
    before = np.zeros((SIZE, SIZE, 4))
    for path in written:
        disk.may_go.clear()
        item = shade(path)
        previews.scene_changed()
        for _ in range(3):
            np.testing.assert_array_equal(draw(previews), before)
        assert previews.is_loading(item)
        assert previews.is_busy
        assert not previews.take_news()
        disk.rest()
        assert previews.take_news()
        after = draw(previews)
        assert previews.messages(item) == []
        assert not np.array_equal(after, before)
        assert (previews.is_loading(item), previews.is_busy) == (False, False)
        assert previews.take_news()  # for the panel
        assert not previews.take_news()
        before = after


def test_the_window_opens_no_file(
    written: dict[str, MapSet], draw: Draw, previews: Previews, disk: SlowDisk
) -> None:
    disk.may_go.set()
    for path in written:  # the first time, programs are built
        shade(path)
        previews.scene_changed()
        draw(previews)
        disk.rest()
        draw(previews)
    again = Previews(LiveFits(), disk)
    again.add_display(bpy.context.scene)
    for path in written:
        shade(path)
        again.scene_changed()
        with opened_by_the_window() as opened:
            draw(again)
            disk.rest()
            shown = draw(again)
        assert shown[..., 3].max() == 1.0
        assert opened == []


def test_large_ones_come_piece_by_piece(
    written: dict[str, MapSet],
    draw: Draw,
    previews: Previews,
    disk: SlowDisk,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    disk.may_go.set()
    expected = {}
    for path in written:
        shade(path)
        previews.scene_changed()
        draw(previews)
        disk.rest()
        expected[path] = draw(previews)
    monkeypatch.setattr(viewport_map_sets, "PIECE_BYTES", 2000)
    again, before = Previews(LiveFits(), disk), np.zeros((SIZE, SIZE, 4))
    for path in written:
        item = shade(path)
        again.scene_changed()
        draw(again)
        disk.rest()
        redraws, shown = 0, before
        while again.is_loading(item):
            assert again.take_news()
            np.testing.assert_array_equal(shown, before)
            shown, redraws = draw(again), redraws + 1
        assert redraws > 1
        before = shown
        np.testing.assert_array_equal(shown, expected[path])


def test_what_goes_wrong_in_the_thread_is_told_and_passes(
    written: dict[str, MapSet],
    draw: Draw,
    previews: Previews,
    disk: SlowDisk,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    def fail(*_: object) -> None:
        raise ZeroDivisionError("by zero")

    first, second, *_ = written
    disk.may_go.set()
    item = shade(first)
    draw(previews)
    disk.rest()
    assert draw(previews)[..., 3].max() == 1.0
    Path(second).write_bytes(b"no map set")
    shade(second)
    previews.scene_changed()
    draw(previews)
    disk.rest()
    assert not draw(previews).any()
    (message,) = previews.messages(item)
    assert second in message
    assert not previews.is_busy

    monkeypatch.setattr(viewport_map_sets, "open_map_set", fail)
    previews.reload()
    draw(previews)
    disk.rest()
    assert not draw(previews).any()
    assert "ZeroDivisionError: by zero" in previews.messages(item)[0]
    assert capsys.readouterr().err.count("Traceback") == 1

    monkeypatch.undo()
    shade(first)
    previews.scene_changed()
    draw(previews)
    disk.rest()
    assert draw(previews)[..., 3].max() == 1.0
    assert previews.messages(item) == []


@pytest.mark.parametrize("leaves", ["object", "map set", "file"])
def test_nobody_waits_for_what_nobody_wants(
    leaves: str, written: dict[str, MapSet], draw: Draw, previews: Previews, disk: SlowDisk
) -> None:
    first, second, *_ = written
    item = shade(first)
    draw(previews)  # the thread is at work with it
    shade(second)
    previews.scene_changed()
    draw(previews)  # this one waits
    (waiting,) = previews._map_sets._coming.values()
    match leaves:
        case "object":
            bpy.data.objects.remove(item)
        case "map set":
            use_map_set(item.rsibr, "")
        case "file":
            previews.release()
    bpy.context.view_layer.update()
    previews.scene_changed()
    if leaves != "file":
        draw(previews)
    assert waiting.read.cancelled()
    assert not previews.is_busy
    disk.rest()
    assert previews._map_sets.used == {}


def test_a_look_that_needs_another_table_leaves_the_last_one(
    draw: Draw, written: dict[str, MapSet], disk: SlowDisk, previews: Previews
) -> None:
    item = shade(next(path for path, each in written.items() if each.kind == "reflection_tables"))
    disk.may_go.set()
    draw(previews)
    disk.rest()
    first, look = draw(previews), item.rsibr.reflection_tables
    assert first.any()
    look.diffuse = "lambert:kd=0.2"
    previews.scene_changed()
    darker = draw(previews)
    assert not np.array_equal(darker, first)
    assert not previews.messages(item)
    look.specular = "phong:ks=0.5,n=7"
    previews.scene_changed()
    assert np.array_equal(draw(previews), darker)
    (message,) = previews.messages(item)
    assert "specular table is another one" in message
    look.specular, look.diffuse = "", ""
    previews.scene_changed()
    assert np.array_equal(draw(previews), first)
    assert not previews.messages(item)
