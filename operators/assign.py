"""Shade the active object from a map set."""

from pathlib import Path

import bpy

from ..rsibr_addon.host.map_sets import stored_path
from ..rsibr_addon.tasks.methods.kinds import kind_of
from .at_once import Undoable
from .file_properties import file_path


class RSIBR_OT_assign(Undoable, bpy.types.Operator):
    """Shade the active object from a map set's file"""  # noqa: D400  (a tooltip)

    bl_idname = "rsibr.assign"
    bl_label = "Assign Map Set"

    filepath = file_path("Map Set", "File to shade from")

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether there is an object that may be changed."""
        return context.object is not None and context.object.is_editable

    def work(self, context: bpy.types.Context) -> None:
        """Assign, if the file is a map set, or a picture of an environment."""
        path = Path(bpy.path.abspath(self.filepath))
        kind_of(path)
        settings = context.object.rsibr
        settings.map_set, settings.show = stored_path(path), True

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask for the file."""
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}
