"""The queue of bakes: a timer looks at it, and assigns what is done."""

import bpy

from ..rsibr_addon.files.baked_inputs import is_whole
from ..rsibr_addon.files.map_set import is_whole_map_set
from ..rsibr_addon.host.bake_settings import assign
from ..rsibr_addon.host.sidebars import redraw_sidebars, redraw_viewports
from ..rsibr_addon.session.running import session
from ..rsibr_addon.tasks.queue.background import State
from ..rsibr_addon.tasks.queue.bake_request import ObjectBake
from ..rsibr_addon.tasks.queue.input_bakes import InputBake
from ..rsibr_addon.tasks.queue.world_bakes import WorldBake

SECONDS = 0.2
"""Between two looks."""


def stop() -> None:
    """Look no more: the extension or Blender goes."""
    if bpy.app.timers.is_registered(_look):
        bpy.app.timers.unregister(_look)


def submit(bake: ObjectBake) -> None:
    """Start a bake, or let it wait for those before it; ended bakes that it replaces leave the queue."""
    bakes = session().bakes
    bakes.forget_ended(lambda ended: _replaces(bake, ended))
    bakes.add(bake)
    if not bpy.app.timers.is_registered(_look):
        bpy.app.timers.register(_look, first_interval=SECONDS, persistent=True)


def look() -> None:
    """Notice what has happened to the bakes, assign what is done, and have the panel show it."""
    for bake in session().bakes.update():
        bake.tidy()
        _count_as_done_if_another_made_it(bake)
        if isinstance(bake, InputBake):
            session().previews.inputs.ended(bake.output, bake.message)
            redraw_viewports()
            continue
        if bake.state is not State.DONE:
            continue
        if isinstance(bake, WorldBake):
            session().previews.reload()
            redraw_viewports()
        elif bake.output.suffix == ".html":
            bpy.ops.wm.url_open(url=bake.output.resolve().as_uri())
        elif bake.settings:
            assign(bake.items, bake.output, bake.settings)
            session().previews.reload()  # it may have replaced a file that is shown
            if not bake.by_itself:
                _push_undo("Assign Map Set")
    redraw_sidebars()


def _replaces(bake: ObjectBake, ended: ObjectBake) -> bool:
    """Whether what a bake has told is of no use once another is asked for.

    A new preview replaces all; a comparison, or a bake that nobody asked for, the last one of its sort alone.
    """
    if bake.settings and not bake.by_itself:
        return True
    sort, other = ((type(each), each.output.suffix, each.by_itself) for each in (bake, ended))
    return sort == other


def _look() -> float | None:
    look()
    return SECONDS if session().bakes.busy else None


def _count_as_done_if_another_made_it(bake: ObjectBake) -> None:
    """Count a bake as done whose file another Blender wrote while it was at work."""
    is_there = is_whole if isinstance(bake, InputBake) else is_whole_map_set
    if bake.state is State.FAILED and bake.output.suffix != ".html" and is_there(bake.output):
        bake.state, bake.message = State.DONE, ""


def _push_undo(message: str) -> None:
    windows = bpy.context.window_manager.windows
    if windows:
        with bpy.context.temp_override(window=windows[0]):
            bpy.ops.ed.undo_push(message=message)
