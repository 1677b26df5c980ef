"""A fault in any one call of Blender or of its graphics costs the preview, is told once, and passes."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import bpy
import gpu
import numpy as np
import pytest
import rsibr
from mathutils import Matrix
from rsibr.rsibr_addon.device.context import ensure_context
from rsibr.rsibr_addon.device.shaders import release_programs
from rsibr.rsibr_addon.files.map_set import write_map_set
from rsibr.rsibr_addon.host.map_sets import use_map_set
from rsibr.rsibr_addon.host.viewport import View
from rsibr.rsibr_addon.tasks.viewport.previews import Previews
from rsibr.rsibr_addon.ui import viewport as ui
from rsibr.tests.faults.small_map_sets import map_sets

SIZE = 32
PROJECTION = Matrix(((0.5, 0, 0, 0), (0, 0.5, 0, 0), (0, 0, -0.02, 0), (0, 0, 0, 1)))
TOOL = 4
"""A number for `sys.monitoring` that nobody else has."""


class InjectedError(Exception):
    """What a call is made to raise."""


type Call = tuple[str, Any, int]
"""What is called, and from where: a name, code, and an offset in it."""


@contextmanager
def fault_in(number: int | None) -> Iterator[list[Call]]:
    """Within, the call of Blender of that number raises an error; tells the calls."""
    calls: list[Call] = []

    def called(code: Any, offset: int, function: Any, first: Any) -> None:
        if is_blenders(function):
            calls.append((getattr(function, "__name__", type(function).__name__), code, offset))
            if len(calls) - 1 == number:
                raise InjectedError(calls[-1][0])

    sys.monitoring.use_tool_id(TOOL, "faults")
    sys.monitoring.register_callback(TOOL, sys.monitoring.events.CALL, called)
    sys.monitoring.set_events(TOOL, sys.monitoring.events.CALL)
    try:
        yield calls
    finally:
        sys.monitoring.set_events(TOOL, 0)
        sys.monitoring.free_tool_id(TOOL)


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
def view() -> Iterator[View]:
    """Of the factory file's viewport, with a cube."""
    bpy.ops.wm.read_factory_settings()
    rsibr.register()
    ensure_context()
    scene, layer = bpy.context.scene, bpy.context.view_layer
    (space,) = (area.spaces.active for area in bpy.context.screen.areas if area.type == "VIEW_3D")
    yield View(scene, (scene.session_uid, layer.name), layer.depsgraph, space)
    rsibr.unregister()


@pytest.fixture
def frame(view: View) -> Callable[[Previews, int | None], tuple[np.ndarray, list[Call], Any]]:
    """Draw as Blender does: a frame, then what the display lacks, then another frame."""
    target = gpu.types.GPUOffScreen(SIZE, SIZE)

    def draw(previews: Previews, number: int | None) -> tuple[np.ndarray, list[Call], Any]:
        with target.bind(), gpu.matrix.push_pop(), gpu.matrix.push_pop_projection():
            framebuffer = gpu.state.active_framebuffer_get()
            framebuffer.clear(color=(0.0, 0.0, 0.0, 0.0), depth=1.0)
            gpu.matrix.load_matrix(Matrix.Identity(4))
            gpu.matrix.load_projection_matrix(PROJECTION)
            gpu.state.depth_test_set("NONE")
            with fault_in(number) as calls:
                if not previews.draw(view):
                    previews.add_display(view.scene)
                    previews.draw(view)
            state = gpu.state.depth_test_get(), gpu.state.depth_mask_get(), gpu.state.blend_get()
            picture = np.array(framebuffer.read_color(0, 0, SIZE, SIZE, 4, 0, "FLOAT").to_list())
        return picture, calls, state

    return draw


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:Maps of 4 texels blur")
def test_a_fault_in_any_call_is_told_once_and_passes(
    tmp_path: Path, frame: Callable[..., Any], capsys: pytest.CaptureFixture[str]
) -> None:
    item, done = bpy.context.object, set[tuple[Any, int]]()
    item.rsibr.show = True
    for map_set in map_sets():
        path = tmp_path / f"{map_set.kind}.rsibr.exr"
        write_map_set(path, map_set)
        use_map_set(item.rsibr, str(path))
        release_programs()
        expected, calls, state = frame(Previews(), None)
        assert expected[..., 3].max() == 1.0
        for number, (name, *place) in enumerate(calls):
            if tuple(place) in done:
                continue
            done.add(tuple(place))
            previews = Previews()
            release_programs()
            _, reached, state_after = frame(previews, number)
            assert reached[number] == calls[number]
            told = previews.trouble or previews.fault(item)
            assert told is not None, name
            assert name.endswith("_set") or state_after == state, name
            _, later, _ = frame(previews, None)
            assert (previews.trouble or previews.fault(item)) == told
            assert previews.trouble is None or later == []
            assert capsys.readouterr().err.count("Traceback") <= 1
            previews.reload()
            # What the fault has left goes during the first of two frames
            picture = [frame(previews, None)[0] for _ in range(2)][-1]
            assert (previews.trouble, previews.fault(item)) == (None, None), name
            np.testing.assert_array_equal(picture, expected, name)
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
    assert ui.previews.trouble is not None
    assert "no view" in ui.previews.trouble
    assert capsys.readouterr().err.count("Traceback") == 1
    ui.previews.reload()
    assert ui.previews.trouble is None
