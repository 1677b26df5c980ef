"""Shade the active object from a map set."""

from pathlib import Path

import bpy

from ..rsibr_addon.host.map_sets import stored_path
from ..rsibr_addon.tasks.methods.kinds import kind_of
from .reporting import reporting


class RSIBR_OT_assign(bpy.types.Operator):
    """Shade the active object from a map set's file"""  # noqa: D400  (a tooltip)

    bl_idname = "rsibr.assign"
    bl_label = "Assign Map Set"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012  (Blender reads the class)

    filepath = bpy.props.StringProperty(
        name="Map Set",
        description="File to shade from",
        subtype="FILE_PATH",
        options={"SKIP_SAVE", "PATH_SUPPORTS_BLEND_RELATIVE"},
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether there is an object that may be changed."""
        return context.object is not None and context.object.is_editable

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Assign, if the file is a map set, or a picture of an environment."""
        with reporting(self):
            path = Path(bpy.path.abspath(self.filepath))
            kind_of(path)
            settings = context.object.rsibr
            settings.map_set, settings.show = stored_path(path), True
            return {"FINISHED"}
        return {"CANCELLED"}

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask for the file."""
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}
