"""The file that the active object is shaded from."""

import bpy

from .sidebar import InSidebar


class RSIBR_PT_map_set(InSidebar, bpy.types.Panel):
    """The file that the active object is shaded from"""  # noqa: D400  (a tooltip)

    bl_label = "Map Set"
    bl_parent_id = "RSIBR_PT_advanced"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether there is an object to be shaded."""
        return context.object is not None

    def draw(self, context: bpy.types.Context) -> None:
        """Show its path."""
        row = self.layout.row(align=True)
        row.prop(context.object.rsibr, "map_set", text="")
        row.operator("rsibr.reload_map_sets", text="", icon="FILE_REFRESH")
