"""Take the active object's map set into the open file."""

import bpy

from ..rsibr_addon.host.map_sets import is_packed, pack, written_path
from ..rsibr_addon.tasks.methods.kinds import open_map_set
from .at_once import Undoable


class RSIBR_OT_pack(Undoable, bpy.types.Operator):
    """Save the active object's map set inside the .blend file"""  # noqa: D400  (a tooltip)

    bl_idname = "rsibr.pack"
    bl_label = "Pack into .blend"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether there is a map set of this file, and it is not packed yet."""
        image = context.object and context.object.rsibr.image
        return bool(image) and image.is_editable and not is_packed(context.object.rsibr)

    def work(self, context: bpy.types.Context) -> None:
        """Pack it; other objects that are shaded from it share what is packed."""
        open_map_set(written_path(context.object.rsibr))  # refuses what is not whole
        pack(context.object.rsibr)
