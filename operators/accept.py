"""Take a map set that has changed for what the active object is to be shaded from."""

import bpy

from ..rsibr_addon.host.map_sets import remember_content
from ..rsibr_addon.tasks.viewport.previews import previews


class RSIBR_OT_accept(bpy.types.Operator):
    """Shade the object from what the file holds now"""  # noqa: D400  (a tooltip)

    bl_idname = "rsibr.accept"
    bl_label = "Accept"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012  (Blender reads the class)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether there is an object that may be changed."""
        return context.object is not None and context.object.is_editable

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Accept it; how it was baked is not known."""
        remember_content(context.object.rsibr)
        previews.reload()
        return {"FINISHED"}
