"""Make an environment from a painted picture."""

from pathlib import Path

import bpy

from ..rsibr_addon.core.progress import Steps
from ..rsibr_addon.files.map_pictures import layout
from ..rsibr_addon.host.option_properties import options_of
from ..rsibr_addon.settings.environment import PaintedSettings
from ..rsibr_addon.tasks.light.painted import illuminate_from_painting
from .from_pictures import FromPictures


class RSIBR_OT_lift_painting(FromPictures, bpy.types.Operator):
    """Make an environment from a painted picture (8 or 16 bits): its whites become lamps. If a layout has several files, select one"""  # noqa: D400, E501  (a tooltip)

    bl_idname = "rsibr.lift_painting"
    bl_label = "Lift Painting"
    SETTINGS = PaintedSettings

    def work(self, context: bpy.types.Context) -> Steps[Path]:
        """Lift the whites."""
        settings = options_of(PaintedSettings, self)
        source = layout(settings.source_layout).whole(self.source())
        return illuminate_from_painting(source, settings, self.target(source), self.force)
