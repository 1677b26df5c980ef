"""Convert a picture of light that is no latitude-longitude map."""

from pathlib import Path

import bpy

from ..rsibr_addon.core.progress import Steps
from ..rsibr_addon.files.pictures import split_layer
from ..rsibr_addon.host.option_properties import options_of
from ..rsibr_addon.settings.convert import SourceLayout
from ..rsibr_addon.tasks.light.convert import made_environment
from .from_pictures import FromPictures


class RSIBR_OT_convert_light(FromPictures, bpy.types.Operator):
    """Make a latitude-longitude map of a picture of light in another layout: an angular map, a mirror ball, a cube"""  # noqa: D400, E501  (a tooltip)

    bl_idname = "rsibr.convert_light"
    bl_label = "Convert Light"
    SETTINGS = SourceLayout

    def target(self, source: Path) -> Path:
        """Beside the picture, under a name that tells the layout."""
        if self.output:
            return super().target(source)
        return source.with_name(f"{source.stem}-from-{self._layout().replace('_', '-')}.exr")

    def work(self, context: bpy.types.Context) -> Steps[Path]:
        """Convert it."""
        source = split_layer(self.source())[0]
        return made_environment(source, self._layout(), self.target(source), self.force)

    def _layout(self) -> str:
        return options_of(SourceLayout, self).source_layout
