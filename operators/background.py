"""The queue of bakes: a timer looks at it, and assigns what is done."""

from contextlib import ExitStack

import bpy

from ..rsibr_addon.host.bake_settings import assign
from ..rsibr_addon.host.sidebars import redraw_sidebars
from ..rsibr_addon.tasks.queue.background import BakeQueue, State
from ..rsibr_addon.tasks.queue.bake_request import ObjectBake, is_baked
from ..rsibr_addon.tasks.viewport.previews import previews

SECONDS = 0.2
"""Between two looks."""

queue = BakeQueue[ObjectBake]()
"""The bakes of this Blender."""


def start(undo: ExitStack) -> None:
    """End all bakes when the extension or Blender ends.

    Parameters
    ----------
    undo : ExitStack
        Takes what ends them.
    """
    undo.callback(_close)


def submit(bake: ObjectBake) -> None:
    """Start a bake, or let it wait for those before it; ended bakes leave the queue."""
    queue.forget_ended()
    queue.add(bake)
    if not bpy.app.timers.is_registered(_look):
        bpy.app.timers.register(_look, first_interval=SECONDS, persistent=True)


def look() -> None:
    """Notice what has happened to the bakes, assign what is done, and have the panel show it."""
    for bake in queue.update():
        bake.tidy()
        _count_as_done_if_another_made_it(bake)
        if bake.state is not State.DONE:
            continue
        if bake.output.suffix == ".html":
            bpy.ops.wm.url_open(url=bake.output.resolve().as_uri())
        else:
            for item in bake.items:
                assign(item, bake.output, bake.settings)
            previews.reload()  # it may have replaced a file that is shown
            _push_undo("Assign Map Set")
    redraw_sidebars()


def _look() -> float | None:
    look()
    return SECONDS if queue.busy else None


def _count_as_done_if_another_made_it(bake: ObjectBake) -> None:
    """Count a bake as done whose file another Blender wrote while it was at work."""
    if bake.state is State.FAILED and bake.output.suffix != ".html" and is_baked(bake.output):
        bake.state, bake.message = State.DONE, ""


def _push_undo(message: str) -> None:
    windows = bpy.context.window_manager.windows
    if windows:
        with bpy.context.temp_override(window=windows[0]):
            bpy.ops.ed.undo_push(message=message)


def _close() -> None:
    if bpy.app.timers.is_registered(_look):
        bpy.app.timers.unregister(_look)
    bakes = list(queue.bakes)
    queue.close()
    for bake in bakes:
        bake.tidy()
