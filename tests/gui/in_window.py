"""What scripts in Blender's window share: steps between redraws, and the pixels that the window shows.

Copied beside them into the folder that Blender sees as /job; not imported by the tests themselves.
"""

import importlib
import json
import math
import os
import time
import traceback
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import bmesh  # noqa: F401
import bpy
import numpy as np
import xshot
from mathutils import Vector  # noqa: F401

ROOT = "bl_ext.user_default.rsibr"
HOLD = Path("/job/hold")
SECONDS = 560.0
"""After these a scenario hangs: a machine that others use too may take most of them."""

bpy.context.preferences.view.show_splash = False
bpy.context.preferences.system.viewport_aa = "OFF"


def view(number: int = 0) -> bpy.types.Area:
    """One of the window's 3D viewports."""
    return [area for area in window().screen.areas if area.type == "VIEW_3D"][number]


def window() -> bpy.types.Window:
    return bpy.context.window_manager.windows[0]


def region(area: bpy.types.Area) -> bpy.types.Region:
    return next(each for each in area.regions if each.type == "WINDOW")


def bare(area: bpy.types.Area) -> None:
    """Surfaces in one colour each, on a background of one colour, and nothing else in the view."""
    space = area.spaces.active
    shading, overlay = space.shading, space.overlay
    shading.type, shading.light, shading.color_type = "SOLID", "FLAT", "OBJECT"
    shading.background_type, shading.background_color = "VIEWPORT", (0.05, 0.05, 0.05)
    shading.show_object_outline = shading.show_cavity = shading.show_specular_highlight = False
    space.show_gizmo = space.show_region_header = space.show_region_toolbar = False
    for name in dir(overlay):
        if name.startswith("show_") and name != "show_overlays":
            setattr(overlay, name, False)
    space.region_3d.view_location = (0.0, 0.0, 0.0)
    space.region_3d.view_distance = 8.0


def viewports() -> list[bpy.types.Region]:
    """What of the window shows scenes."""
    return [region(area) for area in window().screen.areas if area.type == "VIEW_3D"]


draws: Counter[int] = Counter()
"""Address of a viewport -> how often it was drawn."""

bpy.types.SpaceView3D.draw_handler_add(
    lambda: draws.update([bpy.context.region.as_pointer()]), (), "WINDOW", "POST_PIXEL"
)


def drawn() -> Iterator[None]:
    """Let Blender draw every viewport, twice without anything left to wait for; then `pixels` shows it.

    Twice, as a draw is on the screen for sure when another begins: that asks the X server for the window's
    size, which it tells after it has taken all that it was sent.
    """
    settled = 0
    while settled < 2:
        before = draws.copy()
        # Asked for at every step: where a render begins, Blender forgets what it was to draw
        while waiting := [
            each for each in viewports() if draws[each.as_pointer()] == before[each.as_pointer()]
        ]:
            for viewport in waiting:
                viewport.tag_redraw()
            yield
        settled = 0 if previews_wait() else settled + 1


def drawn_with_news() -> Iterator[None]:
    """The same, with what timers bring meanwhile."""
    for _ in range(4):
        yield from drawn()


def session() -> Any:
    """What the extension keeps in memory."""
    return importlib.import_module(ROOT + ".rsibr_addon.session.running").session()


def previews_wait() -> bool:
    """Whether previews are to be drawn once more; what waits for a render's end waits for long."""
    module = importlib.import_module(ROOT + ".rsibr_addon.ui.viewport_handlers")
    timers = [module._draw_again, module._show_news]
    if not bpy.app.is_job_running("RENDER"):
        timers.append(module._add_displays)
    return any(map(bpy.app.timers.is_registered, timers))


def pixels(number: int = 0) -> np.ndarray:
    """What a viewport shows, shape (height, width, 3), 0 to 255, row 0 at the bottom."""
    shown, part = xshot.grab()[::-1], region(view(number))
    return shown[part.y : part.y + part.height, part.x : part.x + part.width].astype(int)


def middle() -> list[float]:
    """Mean colour of the middle of the first viewport."""
    shown = pixels()
    height, width = shown.shape[:2]
    part = shown[height // 2 - 20 : height // 2 + 20, width // 2 - 20 : width // 2 + 20]
    return list(map(float, part.mean(axis=(0, 1))))


def like(picture: np.ndarray, colour: tuple[int, int, int]) -> np.ndarray:
    """Which pixels have a colour, as nearly as drivers encode it: Mesa's errs by 3 from 60 up, by 9 below."""
    return np.all(np.abs(picture - np.array(colour)) <= 3, axis=-1)


def hold(views: int) -> None:
    """Have the captures of every Blender wait once they have so many views: see `held`."""
    HOLD.write_text(str(views))


def let_go() -> None:
    """End a hold."""
    HOLD.unlink()


@contextmanager
def steps_held(most: float = math.inf) -> Iterator[list[str]]:
    """Have what an operator does step by step in the window wait after so many steps.

    Gives the list of those that are taken, as names of operators.
    """
    stepwise = importlib.import_module(ROOT + ".operators.stepwise").Stepwise
    step, taken = stepwise._step, []

    def held(operator: bpy.types.Operator, *rest: object) -> set[str]:
        if len(taken) >= most:
            return {"RUNNING_MODAL"}
        taken.append(operator.bl_idname)
        return step(operator, *rest)

    stepwise._step = held
    try:
        yield taken
    finally:
        stepwise._step = step


def run(scenario: Callable[[dict], Iterator[None]]) -> None:
    """Run a scenario, step by step between Blender's events, print what it told, and end Blender."""
    told: dict = {}
    steps, deadline = scenario(told), time.monotonic() + SECONDS

    def step() -> float:
        try:
            next(steps)
            if time.monotonic() > deadline:
                steps.throw(TimeoutError(f"not done after {SECONDS} seconds"))
        except BaseException as end:
            if not isinstance(end, StopIteration):
                told["error"] = traceback.format_exc()
            print("TOLD", json.dumps(told), flush=True)
            os._exit(0)
        return 0.02

    bpy.app.timers.register(step, first_interval=0.5, persistent=True)
