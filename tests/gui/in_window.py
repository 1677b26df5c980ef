"""What scripts in Blender's window share: steps between redraws, and the pixels that the window shows.

Copied beside them into the folder that Blender sees as /job; not imported by the tests themselves.
"""

import importlib  # noqa: F401  (for the scenarios)
import json
import os
import time
import traceback
from collections.abc import Callable, Iterator

import bmesh  # noqa: F401
import bpy
import numpy as np
import xshot
from mathutils import Vector  # noqa: F401

ROOT = "bl_ext.user_default.rsibr"
SECONDS = 200.0
"""After these a scenario has failed."""

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


def drawn() -> Iterator[None]:
    """Let Blender handle its events and draw until all is there; then `pixels` shows it."""
    for _ in range(3):
        for area in window().screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()
        yield


def pixels(number: int = 0) -> np.ndarray:
    """What a viewport shows, shape (height, width, 3), 0 to 255, row 0 at the bottom."""
    shown, part = xshot.grab()[::-1], region(view(number))
    return shown[part.y : part.y + part.height, part.x : part.x + part.width].astype(int)


def like(picture: np.ndarray, colour: tuple[int, int, int]) -> np.ndarray:
    """Which pixels have a colour, as nearly as drivers encode it: Mesa's errs by 3 from 60 up, by 9 below."""
    return np.all(np.abs(picture - np.array(colour)) <= 3, axis=-1)


def run(scenario: Callable[[dict], Iterator[None]]) -> None:
    """Run a scenario, step by step between Blender's events, print what it told, and end Blender."""
    told: dict = {}
    steps, deadline = scenario(told), time.monotonic() + SECONDS

    def step() -> float:
        try:
            next(steps)
        except BaseException as end:
            if not isinstance(end, StopIteration):
                told["error"] = traceback.format_exc()
            print("TOLD", json.dumps(told), flush=True)
            os._exit(0)
        if time.monotonic() > deadline:
            os._exit(1)
        return 0.02

    bpy.app.timers.register(step, first_interval=0.5, persistent=True)
