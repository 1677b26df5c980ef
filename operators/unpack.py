"""Write the active object's packed map set to a file of its own."""

import bpy

from ..rsibr_addon.host.map_sets import is_packed, unpack
from ..rsibr_addon.host.preferences import baked_folder, make_writable
from .at_once import Undoable


class RSIBR_OT_unpack(Undoable, bpy.types.Operator):
    """Write the active object's packed map set to the folder of baked files, and shade the object from it"""  # noqa: D400  (a tooltip)

    bl_idname = "rsibr.unpack"
    bl_label = "Unpack"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether there is a packed map set of this file."""
        return (
            context.object is not None
            and is_packed(settings := context.object.rsibr)
            and settings.image.is_editable
        )

    def work(self, context: bpy.types.Context) -> None:
        """Write it; nothing that is there is replaced."""
        folder = baked_folder()
        make_writable(folder)
        path = unpack(context.object.rsibr, folder)
        self.report({"INFO"}, f"Wrote {path}")
