"""Merge photographs at several exposures into a picture of radiance."""

from pathlib import Path

import bpy

from ..rsibr_addon.core.errors import RangeError
from ..rsibr_addon.core.progress import Steps
from ..rsibr_addon.files.exposure_times import exposure_time
from ..rsibr_addon.tasks.light.brackets import BracketSettings, Curve, illuminate_from_brackets
from .from_pictures import FromSeveralPictures


class RSIBR_OT_merge_brackets(FromSeveralPictures, bpy.types.Operator):
    """Merge photographs at several exposures into one picture of radiance, laid out as they are"""  # noqa: D400  (a tooltip)

    bl_idname = "rsibr.merge_brackets"
    bl_label = "Merge Brackets"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012  (Blender reads the class)

    times = bpy.props.StringProperty(
        name="Exposure Times",
        description="In seconds, 1/125 or 0.5, one for each photograph in the order in which they are "
        "listed; empty for what the files tell",
        options={"SKIP_SAVE"},
    )
    curve = bpy.props.EnumProperty(
        name="Curve",
        description="How the camera encodes light; OpenEXR and Radiance HDR are linear",
        items=[
            (Curve.RECOVERED.value, "Recovered", "Found from the photographs"),
            (Curve.SRGB.value, "sRGB", "Known to be that of sRGB"),
            (Curve.LINEAR.value, "Linear", "Known to be none"),
        ],
    )
    align = bpy.props.BoolProperty(
        name="Align", description="Undo the camera's movements between the photographs", default=True
    )

    def work(self, context: bpy.types.Context) -> Steps[Path]:
        """Merge."""
        photographs = self.sources()
        output = self.target(photographs[0])
        settings = BracketSettings(photographs, self._times(), Curve(self.curve), self.align)
        yield from illuminate_from_brackets(settings, output, self.force)
        return output

    def _times(self) -> tuple[float, ...] | None:
        words = self.times.replace(",", " ").split()
        try:
            return tuple(exposure_time(word) for word in words) or None
        except ValueError as error:
            raise RangeError(f"{error}: write 1/125 or 0.5, one for each photograph.") from error
