"""Merge photographs at several exposures into a picture of radiance."""

from pathlib import Path

import bpy

from ..rsibr_addon.core.progress import Steps
from ..rsibr_addon.host.option_properties import options_of
from ..rsibr_addon.settings.photographs import BracketSettings
from ..rsibr_addon.tasks.light.brackets import illuminate_from_brackets
from .from_pictures import FromSeveralPictures


class RSIBR_OT_merge_brackets(FromSeveralPictures, bpy.types.Operator):
    """Merge photographs at several exposures into one picture of radiance with the same layout"""  # noqa: D400  (a tooltip)

    bl_idname = "rsibr.merge_brackets"
    bl_label = "Merge Brackets"
    SETTINGS = BracketSettings

    def work(self, context: bpy.types.Context) -> Steps[Path]:
        """Merge."""
        photographs = self.sources()
        output = self.target(photographs[0])
        settings = options_of(BracketSettings, self)
        yield from illuminate_from_brackets(photographs, settings, output, self.force)
        return output
