"""Make a library of assets of the materials that come with us."""

import bpy

from ..rsibr_addon.host.assets import add_library, asset_folder
from ..rsibr_addon.host.preferences import EXTENSION
from ..rsibr_addon.session.running import session
from ..rsibr_addon.tasks.queue.assets_bake import assets_bake_in
from . import background
from .at_once import AtOnce


class RSIBR_OT_add_materials(AtOnce, bpy.types.Operator):
    """Have asset browsers offer metals, plastics and paints, in a library of the user's preferences"""  # noqa: D400  (a tooltip)

    bl_idname = "rsibr.add_materials"
    bl_label = "Add Materials to Asset Browser"

    def work(self, context: bpy.types.Context) -> None:
        """Queue the materials' pictures, unless that was done already."""
        folder = asset_folder(EXTENSION)
        add_library(folder)
        making = assets_bake_in(folder)
        if session().bakes.unfinished(making.output) is not None:
            making.tidy()
            self.report({"INFO"}, "The materials are being made already")
            return
        background.submit(making)
        self.report({"INFO"}, "Making materials: choose the library RSIBR in an Asset Browser")
