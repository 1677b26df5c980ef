"""Make images of the active object's tables, to be painted."""

from pathlib import Path

import bpy

from ..rsibr_addon.files.output_paths import bare_name
from ..rsibr_addon.files.painted import paintable_maps
from ..rsibr_addon.host.map_sets import written_path
from ..rsibr_addon.host.painted import begin_painting
from ..rsibr_addon.tasks.queue.bake_request import plain_name
from .at_once import Undoable


class RSIBR_OT_edit_as_images(Undoable, bpy.types.Operator):
    """Make images of the active object's reflection tables. Paint them in an Image Editor; the preview follows each stroke"""  # noqa: D400, E501  (a tooltip)

    bl_idname = "rsibr.edit_as_images"
    bl_label = "Edit as Images"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether there is a map set that is not painted yet."""
        item = context.object
        return item is not None and item.is_editable and bool(item.rsibr.map_set) and not item.rsibr.painted

    def work(self, context: bpy.types.Context) -> None:
        """Make them, and show the first in the Image Editors of the window."""
        settings = context.object.rsibr
        path = written_path(settings)
        begin_painting(settings, paintable_maps(path), bare_name(Path(plain_name(path))))
        for area in context.screen.areas if context.screen else ():
            if area.type == "IMAGE_EDITOR":
                area.spaces.active.image = settings.painted[0].image
                area.spaces.active.mode = "PAINT"
        made = ", ".join(each.image.name for each in settings.painted)
        self.report({"INFO"}, f"Paint in an Image Editor: {made}")
