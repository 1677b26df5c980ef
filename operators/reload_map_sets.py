"""Read the map sets of previews anew."""

import bpy

from ..rsibr_addon.session.running import session
from .at_once import AtOnce


class RSIBR_OT_reload_map_sets(AtOnce, bpy.types.Operator):
    """Read the files of all map sets again, and retry what failed"""  # noqa: D400  (a tooltip)

    bl_idname = "rsibr.reload_map_sets"
    bl_label = "Reload Map Sets"
    bl_options = {"REGISTER"}  # noqa: RUF012  (Blender reads the class)

    def work(self, context: bpy.types.Context) -> None:
        """Release what is uploaded; the next redraw reads the files."""
        session().previews.reload()
        for window in context.window_manager.windows:
            for area in window.screen.areas:
                area.tag_redraw()
