"""Shade the active object from its tables as they were before they were painted."""

import bpy

from ..rsibr_addon.host.painted import end_painting
from .at_once import Undoable


class RSIBR_OT_discard_paint(Undoable, bpy.types.Operator):
    """Forget what was painted, and shade the object from its map set again"""  # noqa: D400  (a tooltip)

    bl_idname = "rsibr.discard_paint"
    bl_label = "Discard"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether tables are painted."""
        item = context.object
        return item is not None and item.is_editable and bool(item.rsibr.painted)

    def work(self, context: bpy.types.Context) -> None:
        """Remove the images."""
        end_painting(context.object.rsibr)
