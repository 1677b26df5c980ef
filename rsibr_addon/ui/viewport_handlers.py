"""Handlers that draw previews in viewports."""

from collections.abc import Callable
from contextlib import ExitStack
from functools import wraps
from typing import Concatenate, ParamSpec, TypeVar

import bpy
from bpy.app.handlers import persistent

from ..device.shaders import release_programs
from ..host.handlers import add_handlers
from ..host.materials import materials_changed
from ..host.painted import painted_files
from ..host.sidebars import redraw_viewports
from ..host.visible_surfaces import RENDER_ENGINE, current_view, shown_layers
from ..session.running import Session, session

Given = ParamSpec("Given")
Result = TypeVar("Result")

RETRY_SECONDS = 0.5
"""While a render goes on, no data may come and go for the display's table."""

REST_SECONDS = 1.0
"""After the last edit, until materials that were changed are baked."""

NEWS_SECONDS = 0.03
"""How often to look whether a map set has been read, or a material been made."""


def start(undo: ExitStack) -> None:
    """Draw previews in every viewport from now on; a Blender without windows has none.

    Parameters
    ----------
    undo : ExitStack
        Takes what ends it.
    """
    if bpy.app.background:
        return
    undo.callback(release_programs)
    moments = ((_before_surfaces, "PRE_VIEW"), (_draw, "POST_VIEW"), (_render_surroundings, "POST_PIXEL"))
    for function, when in moments:
        handle = bpy.types.SpaceView3D.draw_handler_add(function, (), "WINDOW", when)
        undo.callback(bpy.types.SpaceView3D.draw_handler_remove, handle, "WINDOW")
    undo.callback(_stop_timers)
    add_handlers(_HANDLERS, undo)


def _guarded(
    function: Callable[Concatenate[Session, Given], Result],
) -> Callable[Given, Result | None]:
    """Have what goes wrong in a function that Blender calls told once; it is given the session."""

    @wraps(function)
    def run(*given: Given.args, **named: Given.kwargs) -> Result | None:
        running = session()
        with running.previews.faults.guarded():
            return function(running, *given, **named)
        return None

    return run


@_guarded
def _before_surfaces(running: Session) -> None:
    running.previews.before_surfaces()


@_guarded
def _draw(running: Session) -> None:
    if not running.previews.draw(current_view()) and not bpy.app.timers.is_registered(_add_displays):
        bpy.app.timers.register(_add_displays, first_interval=0.0)
    if _is_busy(running) and not bpy.app.timers.is_registered(_show_news):
        bpy.app.timers.register(_show_news, first_interval=NEWS_SECONDS)
    if running.previews.worlds.is_unasked and not bpy.app.timers.is_registered(_ask_for_world):
        bpy.app.timers.register(_ask_for_world, first_interval=0.0)
    if running.previews.inputs.is_unasked and not bpy.app.timers.is_registered(_ask_for_inputs):
        bpy.app.timers.register(_ask_for_inputs, first_interval=0.0)


@_guarded
def _render_surroundings(running: Session) -> None:
    """Blender renders no view while it draws another, but when it comes to what lies over it."""
    view = current_view()
    changed = running.previews.render_surroundings(view), running.previews.render_compared(view)
    if any(changed) and not bpy.app.timers.is_registered(_draw_again):
        bpy.app.timers.register(_draw_again, first_interval=0.0)


@_guarded
def _show_news(running: Session) -> float | None:
    """While map sets are read and materials are made, show what there is of them."""
    goes_on = _is_busy(running)
    news = running.worker.take_news(), running.previews.take_news()
    if any(news):
        _draw_again()
    return NEWS_SECONDS if goes_on else None


def _is_busy(running: Session) -> bool:
    return running.worker.is_busy or running.previews.is_busy


@_guarded
def _draw_again(_: Session) -> None:
    redraw_viewports()


@_guarded
def _ask_for_inputs(running: Session) -> None:
    """After edits have rested: show what is baked of materials as they are now, or have it baked."""
    running.previews.inputs.is_unasked = False
    if running.previews.has_baked_inputs:
        for window in shown_layers().values():
            with bpy.context.temp_override(window=window):
                bpy.ops.rsibr.bake_inputs(by_itself=True)
        redraw_viewports()


@_guarded
def _ask_for_world(running: Session) -> None:
    """After edits have rested: have the world baked that is shown as it was before."""
    running.previews.worlds.is_unasked = False
    for window in shown_layers().values():
        if window.scene.render.engine == RENDER_ENGINE and window.scene.world:
            with bpy.context.temp_override(window=window):
                bpy.ops.rsibr.bake_world()


def _ask_soon(asks: Callable[[], None]) -> None:
    if bpy.app.timers.is_registered(asks):
        bpy.app.timers.unregister(asks)
    bpy.app.timers.register(asks, first_interval=REST_SECONDS)


@_guarded
def _add_displays(running: Session) -> float | None:
    """Learn how the scenes in the windows show radiance, and have them drawn again."""
    if bpy.app.is_job_running("RENDER"):
        return RETRY_SECONDS
    for scene in {window.scene for window in bpy.context.window_manager.windows}:
        running.previews.add_display(scene)
    _draw_again()
    return None


def _stop_timers() -> None:
    timers = _add_displays, _draw_again, _show_news, _ask_for_inputs, _ask_for_world
    for timer in filter(bpy.app.timers.is_registered, timers):
        bpy.app.timers.unregister(timer)


@persistent
@_guarded
def _scene_changed(running: Session, scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    # A render evaluates scenes too, in a thread of its own
    if depsgraph.mode == "VIEWPORT" and not running.previews.is_hiding:
        painted_files.changed(each.id for each in depsgraph.updates if isinstance(each.id, bpy.types.Image))
        running.previews.scene_changed(materials_changed(depsgraph))
        if running.previews.has_baked_inputs:
            _ask_soon(_ask_for_inputs)
        if bpy.app.timers.is_registered(_ask_for_world):
            _ask_soon(_ask_for_world)


@persistent
@_guarded
def _data_replaced(running: Session, *_: object) -> None:
    painted_files.all_changed()
    running.previews.data_replaced()


@persistent
@_guarded
def _file_closed(running: Session, *_: object) -> None:
    running.previews.release()


_HANDLERS: dict[str, Callable[..., None]] = {
    "depsgraph_update_post": _scene_changed,
    "frame_change_post": _scene_changed,
    "undo_post": _data_replaced,
    "redo_post": _data_replaced,
    "load_pre": _file_closed,
}
