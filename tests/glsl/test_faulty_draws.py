"""A fault in any call of Blender, or any read of its data, costs the preview, is told once, and passes."""

import dis
import itertools
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any

import bpy
import gpu
import numpy as np
import pytest
from mathutils import Matrix
from rsibr.rsibr_addon import host
from rsibr.rsibr_addon.core.at_once import AtOnce
from rsibr.rsibr_addon.device.shaders import release_programs
from rsibr.rsibr_addon.files.map_set import MapSet, write_map_set
from rsibr.rsibr_addon.host.map_sets import use_map_set
from rsibr.rsibr_addon.host.visible_surfaces import View
from rsibr.rsibr_addon.session.running import session
from rsibr.rsibr_addon.tasks import viewport
from rsibr.rsibr_addon.tasks.methods.live_materials import LiveFits
from rsibr.rsibr_addon.tasks.viewport import live_light
from rsibr.rsibr_addon.tasks.viewport.previews import Previews
from rsibr.rsibr_addon.ui import viewport_handlers as ui
from rsibr.tests.faults.small_map_sets import map_sets

STRIDE = 1 if "RSIBR_MOMENTS" in os.environ else 5
"""Of so many faults one is tried, unless all are asked for."""

SIZE = 32
PROJECTION = Matrix(((0.5, 0, 0, 0), (0, 0.5, 0, 0), (0, 0, -0.02, 0), (0, 0, 0, 1)))
TOOL = 4
"""A number for `sys.monitoring` that nobody else has."""


class InjectedError(Exception):
    """What a call is made to raise."""


Place = tuple[Any, int]
"""Code, and an offset in it."""


ENDING = ("bare", "hidden")
"""What cannot but end its state: a call that fails there leaves it, as where an object is not shown again."""

CALLS, READS = sys.monitoring.events.CALL, sys.monitoring.events.INSTRUCTION
"""Where faults are: in calls of Blender, or in reads of attributes, most of which are its properties."""


@contextmanager
def fault_at(place: Place | None, where: int) -> Iterator[dict[Place, str]]:
    """Within, a call of Blender, or a read, raises an error the first time; tells all of them, with names.

    Without `where`, which takes time, it tells none.
    """
    found: dict[Place, str] = {}

    def reach(name: str, code: Any, offset: int) -> None:
        known = (code, offset) in found
        found.setdefault((code, offset), name)
        if not known and (code, offset) == place:
            raise InjectedError(name)

    def called(code: Any, offset: int, function: Any, first: Any) -> None:
        if is_blenders(function) and code.co_filename != __file__ and code.co_name not in ENDING:
            reach(getattr(function, "__name__", type(function).__name__), code, offset)

    def reached(code: Any, offset: int) -> Any:
        name = reads(code).get(offset)
        if name is None:
            return sys.monitoring.DISABLE
        reach(name, code, offset)
        return None

    if not where:
        yield found
        return
    sys.monitoring.use_tool_id(TOOL, "faults")
    sys.monitoring.register_callback(TOOL, where, called if where == CALLS else reached)
    sys.monitoring.restart_events()
    sys.monitoring.set_events(TOOL, where)
    try:
        yield found
    finally:
        sys.monitoring.set_events(TOOL, 0)
        sys.monitoring.free_tool_id(TOOL)


@cache
def reads(code: Any) -> dict[int, str]:
    """Offset -> attribute, of reads of Blender's data and the like; `ENDING` cannot but end their states."""
    folder = Path(code.co_filename).parent
    if folder not in (Path(host.__file__).parent, Path(viewport.__file__).parent) or code.co_name in ENDING:
        return {}
    return {
        each.offset: each.argval
        for before, each in itertools.pairwise(dis.get_instructions(code))
        if each.opname == "LOAD_ATTR" and before.argval != "self"
    }


def is_blenders(function: Any) -> bool:
    """Whether a function is of Blender or its graphics; what ends a binding there cannot but do so."""
    name = getattr(function, "__name__", type(function).__name__)
    owner = function if isinstance(function, type) else getattr(function, "__objclass__", None)
    owner = owner or type(getattr(function, "__self__", None))
    module = getattr(function, "__module__", None) or ""
    return name != "__exit__" and (
        name == "bpy_func"
        or owner.__name__.startswith(("GPU", "bpy_", "Matrix"))
        or owner.__module__.startswith("bpy")
        or module.startswith(("bpy", "gpu"))
    )


@pytest.fixture
def frame(view: View) -> Callable[..., tuple[np.ndarray, dict[Place, str], Any]]:
    """Draw as Blender does: a frame, then what the display and the light lack, then another frame."""
    target, states = gpu.types.GPUOffScreen(SIZE, SIZE), list[Any]()
    (window,) = bpy.context.window_manager.windows
    (area,) = (area for area in window.screen.areas if area.type == "VIEW_3D")
    (region,) = (region for region in area.regions if region.type == "WINDOW")

    def shown(previews: Previews) -> None:
        with target.bind(), gpu.matrix.push_pop(), gpu.matrix.push_pop_projection():
            gpu.state.active_framebuffer_get().clear(color=(0.0, 0.0, 0.0, 0.0), depth=1.0)
            gpu.matrix.load_matrix(Matrix.Identity(4))
            gpu.matrix.load_projection_matrix(PROJECTION)
            # Renders of surroundings are Blender's own drawing, which leaves some of it changed
            gpu.state.depth_test_set("NONE")
            gpu.state.depth_mask_set(True)
            gpu.state.blend_set("NONE")
            draw_twice(previews)
            states.append((gpu.state.depth_test_get(), gpu.state.depth_mask_get(), gpu.state.blend_get()))

    def draw_twice(previews: Previews) -> None:
        guarded = previews.faults.guarded
        with guarded():
            if previews.draw(view):
                return
        with guarded():
            previews.add_display(view.scene)
        with guarded():
            previews.draw(view)

    def lit(previews: Previews) -> bool:
        with previews.faults.guarded():
            return previews.render_surroundings(view)
        return False

    def draw(
        previews: Previews, place: Place | None = None, where: int = 0
    ) -> tuple[np.ndarray, dict[Place, str], Any]:
        ours = bpy.context.temp_override(window=window, area=area, region=region)
        with ours, fault_at(place, where) as found:
            shown(previews)
            while lit(previews):
                shown(previews)
        with target.bind():
            framebuffer = gpu.state.active_framebuffer_get()
            picture = np.array(framebuffer.read_color(0, 0, SIZE, SIZE, 4, 0, "FLOAT").to_list())
        return picture, found, states[-1]

    return draw


@pytest.fixture
def shade(
    tmp_path: Path, frame: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> Callable[[MapSet | None], bpy.types.Object]:
    """Have the cube shaded from a map set, or in live light."""

    def choose(map_set: MapSet | None) -> bpy.types.Object:
        item = bpy.context.object
        item.rsibr.show = True
        if map_set is None:
            # All faces at once, however long they take
            monkeypatch.setattr(live_light, "faces_within", lambda budget, seconds: 6)
            # Programs of mips are compiled sooner, and those of own materials have had their faults by then
            live = item.rsibr.live
            live.on, live.size, live.mips = True, "32", True
        else:
            path = tmp_path / f"{map_set.kind}.rsibr.exr"
            write_map_set(path, map_set)
            use_map_set(item.rsibr, str(path))
        return item

    return choose


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:Maps of 4 texels blur")
@pytest.mark.parametrize("where", [CALLS, READS])
def test_a_fault_in_any_call_or_read_is_told_once_and_passes(
    where: int, shade: Callable[..., Any], frame: Callable[..., Any], capsys: pytest.CaptureFixture[str]
) -> None:
    done = set[Place]()
    for map_set in (*map_sets(), None):
        item = shade(map_set)
        release_programs()
        expected, names, state = frame(Previews(LiveFits(), AtOnce()), None, where)
        assert expected[..., 3].max() == 1.0
        new = [place for place in names if place not in done]
        done.update(new)
        for place in new[::STRIDE]:
            name = names[place]
            previews = Previews(LiveFits(), AtOnce())
            release_programs()
            _, reached, state_after = frame(previews, place, where)
            assert place in reached
            told = previews.faults.trouble or previews.faults.message(item)
            assert told is not None, name
            assert name.endswith("_set") or state_after == state, name
            _, later, _ = frame(previews)
            assert (previews.faults.trouble or previews.faults.message(item)) == told
            assert previews.faults.trouble is None or not later
            assert capsys.readouterr().err.count("Traceback") <= 1
            previews.reload()
            # What the fault has left goes during the first of two frames
            picture = [frame(previews)[0] for _ in range(2)][-1]
            assert (previews.faults.trouble, previews.faults.message(item)) == (None, None), name
            kind = map_set.kind if map_set else "live light"
            np.testing.assert_array_equal(picture, expected, f"{name} in {place[0].co_qualname}, {kind}")
    assert len(done) > 50


@pytest.mark.usefixtures("view")
def test_what_blender_calls_never_raises(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def fail() -> None:
        raise InjectedError("no view")

    monkeypatch.setattr(ui, "current_view", fail)
    for handler in (ui._draw, ui._render_surroundings, ui._draw):
        handler()
    assert session().previews.faults.trouble is not None
    assert "no view" in session().previews.faults.trouble
    assert capsys.readouterr().err.count("Traceback") == 1
    session().previews.reload()
    assert session().previews.faults.trouble is None
