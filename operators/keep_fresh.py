"""After an edit: look what is out of date, and bake anew what follows the world."""

from collections.abc import Callable, Collection
from contextlib import ExitStack, suppress
from pathlib import Path

import bpy
from bpy.app.handlers import persistent

from ..rsibr_addon.core.errors import RsibrError
from ..rsibr_addon.core.warned import recorded_warnings
from ..rsibr_addon.host.handlers import add_handlers
from ..rsibr_addon.host.materials import materials_changed
from ..rsibr_addon.host.sidebars import redraw_sidebars
from ..rsibr_addon.session.running import session
from ..rsibr_addon.tasks.queue.background import State
from .bake_in_background import queue_bake

SECONDS = 0.4
"""After the last edit; while a slider is being moved, nothing is looked at."""


def start(undo: ExitStack) -> None:
    """Look from now on; a Blender without windows has nobody to tell.

    Parameters
    ----------
    undo : ExitStack
        Takes what ends it.
    """
    if bpy.app.background:
        return
    undo.callback(_stop)
    add_handlers(_HANDLERS, undo)


@persistent
def _edited(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    if depsgraph.mode != "VIEWPORT":  # A render evaluates scenes too, in a thread of its own
        return
    of_materials = materials_changed(depsgraph)
    if of_materials:
        session().material_notes.forget()
    changed = (update.id.original for update in depsgraph.updates)
    objects = [each for each in changed if isinstance(each, bpy.types.Object)]
    of_world = depsgraph.id_type_updated("WORLD")
    if of_materials or of_world or session().freshness.has_changed(scene, objects):
        _look_soon()


@persistent
def _replaced(*_: object) -> None:
    session().material_notes.forget()
    _look_soon()


def _look_soon() -> None:
    _stop()
    bpy.app.timers.register(_look, first_interval=SECONDS)


def _stop() -> None:
    if bpy.app.timers.is_registered(_look):
        bpy.app.timers.unregister(_look)


def _look() -> None:
    """Look at the scenes of the windows. What cannot be baked is told in the panel, where it is asked for."""
    freshness, scenes = session().freshness, {window.scene for window in bpy.context.window_manager.windows}
    with recorded_warnings():
        freshness.look(scenes)
        wanted = [(scene, *each) for scene in scenes for each in freshness.wanted(scene) if each[0].by_itself]
        _cancel_all_but({(stale.output, item.session_uid) for _, stale, items in wanted for item in items})
        for scene, stale, items in wanted:
            if stale.request is not None and not _has_ended_badly(stale.output):
                with suppress(RsibrError, OSError):
                    queue_bake(scene, stale.request, items, by_itself=True)
    redraw_sidebars()


def _cancel_all_but(wanted: Collection[tuple[Path | None, int]]) -> None:
    """Cancel bakes that nobody asked for, for all objects but those that still want their files."""
    for bake in session().bakes.bakes:
        if bake.by_itself and not bake.ended:
            bake.items = [number for number in bake.items if (bake.output, number) in wanted]
            if not bake.items:
                bake.cancel()
                bake.tidy()


def _has_ended_badly(output: Path | None) -> bool:
    """Whether the last bake of a file failed, or was cancelled: then the artist has to ask for it."""
    return any(
        bake.output == output and bake.state in (State.FAILED, State.CANCELLED)
        for bake in session().bakes.bakes
    )


_HANDLERS: dict[str, Callable[..., None]] = {
    "depsgraph_update_post": _edited,
    "frame_change_post": _edited,
    "undo_post": _replaced,
    "redo_post": _replaced,
    "load_post": _replaced,
}
