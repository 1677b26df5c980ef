"""Make an environment from a painted picture."""

from pathlib import Path

import bpy

from ..rsibr_addon.core.maps.representation import REPRESENTATIONS
from ..rsibr_addon.core.progress import Steps
from ..rsibr_addon.files.map_pictures import CUBES, layout
from ..rsibr_addon.tasks.light.painted import PaintedSettings, illuminate_from_painting
from .from_pictures import EnvironmentSize, FromPictures

LAYOUTS = (*(name for name in REPRESENTATIONS if name != "cube_map"), *CUBES)


class RSIBR_OT_lift_painting(FromPictures, EnvironmentSize, bpy.types.Operator):
    """Make an environment from a picture of 8 or 16 bits, whose whites become lamps"""  # noqa: D400  (a tooltip)

    bl_idname = "rsibr.lift_painting"
    bl_label = "Lift Painting"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012  (Blender reads the class)

    source_layout = bpy.props.EnumProperty(
        name="Layout",
        description="How the picture is laid out; where that takes several files, select one of them",
        items=[(name, name.replace("_", " ").title(), "") for name in LAYOUTS],
    )
    white = bpy.props.FloatVectorProperty(
        name="White",
        description="Radiance that white becomes in red, green and blue; the darker a colour the less it is "
        "lifted",
        default=(10.0, 10.0, 10.0),
        min=1.0,
    )
    knee = bpy.props.FloatProperty(
        name="Knee",
        description="Linear luminance up to which nothing is lifted",
        default=0.7,
        min=0.0,
        max=0.99,
    )

    def work(self, context: bpy.types.Context) -> Steps[Path]:
        """Lift the whites."""
        source = layout(self.source_layout).whole(self.source())
        red, green, blue = self.white
        settings = PaintedSettings(self.source_layout, self.size, (red, green, blue), self.knee)
        return illuminate_from_painting(source, settings, self.target(source), self.force)
