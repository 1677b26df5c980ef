"""The button, what it will cost, and the queue behind it."""

import bpy

from ..core.errors import RsibrError
from ..session.running import session
from ..tasks.queue.background import Bake, State
from ..tasks.queue.bake_request import request_for
from .sentences import amount, capital, duration, tell
from .sidebar import InSidebar


class RSIBR_PT_bake(InSidebar, bpy.types.Panel):
    """Bake in the background"""  # noqa: D400  (a tooltip)

    bl_label = "Bake"

    def draw(self, context: bpy.types.Context) -> None:
        """Show what a bake would cost or what it lacks, the button, and every bake."""
        layout, width = self.layout, context.region.width
        try:
            cost = request_for(context.scene, context.object).cost
        except RsibrError as error:
            tell(layout, str(error), width)
        else:
            takes = f"{amount(cost.memory)} of memory, {amount(cost.disk)} on disk"
            tell(layout, capital(f"{duration(cost.seconds)}, {takes}"), width, icon="TIME")
        row = layout.row()
        row.scale_y = 1.5
        row.operator("rsibr.bake", text="Bake", icon="RENDER_STILL")
        for number, bake in enumerate(session().bakes.bakes):
            _draw_bake(layout.box(), bake, number, width)


def _draw_bake(layout: bpy.types.UILayout, bake: Bake, number: int, width: int) -> None:
    row = layout.row()
    row.label(text=bake.title, icon=_ICONS[bake.state])
    row.operator("rsibr.cancel_bake", text="", icon="X", emboss=False).number = number
    match bake.state:
        case State.RUNNING:
            what = "starting Blender" if bake.progress is None else bake.progress.what
            left = "" if bake.seconds_left is None else f"{duration(bake.seconds_left)} left"
            layout.progress(factor=bake.fraction, text=capital(left))
            tell(layout, capital(what), width, icon="NONE")
        case State.FAILED:
            tell(layout, bake.message, width)
    for warning in bake.warnings:
        tell(layout, warning, width, icon="INFO")


_ICONS = {
    State.WAITING: "PAUSE",
    State.RUNNING: "PLAY",
    State.DONE: "CHECKMARK",
    State.FAILED: "ERROR",
    State.CANCELLED: "CANCEL",
}
