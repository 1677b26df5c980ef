"""The queue of bakes, and how far each is."""

from collections.abc import Sequence

import bpy

from ..tasks.queue.background import Bake, State
from .sentences import BUTTON_WIDTH, capital, duration, tell


def draw_bakes(layout: bpy.types.UILayout, bakes: Sequence[Bake], width: int) -> None:
    """Show every bake of the queue.

    Parameters
    ----------
    layout : bpy.types.UILayout
    bakes : sequence of Bake
    width : int
        See `panel_width`.
    """
    for number, bake in enumerate(bakes):
        _draw_bake(layout, bake, number, width)


def draw_progress(layout: bpy.types.UILayout, bake: Bake, width: int) -> None:
    """Show how far a bake is that has not ended."""
    if bake.state is State.WAITING:
        layout.label(text="Waits for other bakes", icon=_ICONS[bake.state])
        return
    what = "starting Blender" if bake.progress is None else bake.progress.what
    if bake.elsewhere:
        what = f"farm: {what}"
    left = "" if bake.seconds_left is None else f"{duration(bake.seconds_left)} left"
    layout.progress(factor=bake.fraction, text=capital(left))
    tell(layout, capital(what), width, icon="NONE")


def _draw_bake(layout: bpy.types.UILayout, bake: Bake, number: int, width: int) -> None:
    """Show a bake in one line, and below it what goes on, why it failed or, on demand, its warnings."""
    if not bake.warnings:
        _draw_title(layout.row(), bake, number, width)
    else:
        header, opened = layout.panel(f"RSIBR_bake_{bake.output.name}", default_closed=True)
        _draw_title(header, bake, number, width)
        for warning in bake.warnings if opened else ():
            tell(opened, warning, width, icon="INFO")
    if bake.state is State.RUNNING:
        draw_progress(layout, bake, width)
    elif bake.state is State.FAILED:
        tell(layout, bake.message, width)


def _draw_title(row: bpy.types.UILayout, bake: Bake, number: int, width: int) -> None:
    tell(row, bake.title, width - BUTTON_WIDTH, icon=_ICONS[bake.state])
    row.operator("rsibr.cancel_bake", text="", icon="X", emboss=False).number = number


_ICONS = {
    State.WAITING: "PAUSE",
    State.RUNNING: "PLAY",
    State.DONE: "CHECKMARK",
    State.FAILED: "ERROR",
    State.CANCELLED: "CANCEL",
}
