"""Accept that the file of the active object's map set has changed."""

import bpy

from ..rsibr_addon.host.map_sets import remember_content
from ..rsibr_addon.session.running import session
from .at_once import Undoable


class RSIBR_OT_accept(Undoable, bpy.types.Operator):
    """Shade the object from what the file holds now"""  # noqa: D400  (a tooltip)

    bl_idname = "rsibr.accept"
    bl_label = "Accept"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether there is an object that may be changed."""
        return context.object is not None and context.object.is_editable

    def work(self, context: bpy.types.Context) -> None:
        """Accept it; how it was baked is not known."""
        remember_content(context.object.rsibr)
        session().previews.reload()
