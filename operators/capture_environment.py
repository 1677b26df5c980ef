"""Capture the light around an object or a point of the open file."""

from pathlib import Path

import bpy

from ..rsibr_addon.core.errors import SceneError
from ..rsibr_addon.core.progress import Steps
from ..rsibr_addon.host.option_properties import options_of
from ..rsibr_addon.settings.environment import Capture, SceneLight, WorldLight
from ..rsibr_addon.tasks.light.scene import illuminate_from_scene
from ..rsibr_addon.tasks.light.world import illuminate_from_world
from .file_properties import file_path
from .makes_light import MakesLight


class RSIBR_OT_capture_environment(MakesLight, bpy.types.Operator):
    """Render the light that arrives at a point into a latitude-longitude picture"""  # noqa: D400  (a tooltip)

    bl_idname = "rsibr.capture_environment"
    bl_label = "Capture Environment"
    SETTINGS = Capture
    proposed = "environment.exr"

    filepath = file_path("Picture", "File to write, OpenEXR or Radiance HDR by its name")
    source = bpy.props.EnumProperty(
        name="Light",
        description="What light is captured",
        items=[
            (
                "OBJECT",
                "Around Object",
                "The scene around the middle of the active object, without it and its children",
            ),
            ("CURSOR", "Around Cursor", "The scene around the 3D cursor"),
            ("WORLD", "World", "The world alone; of the settings only the size counts"),
        ],
    )

    def work(self, context: bpy.types.Context) -> Steps[Path]:
        """Capture, one render per step."""
        output = Path(bpy.path.abspath(self.filepath))
        capture = options_of(Capture, self)
        if self.source == "WORLD":
            return illuminate_from_world(WorldLight(size=capture.size), output, self.force)
        subject = None
        if self.source == "OBJECT":
            if context.active_object is None:
                raise SceneError("There is no object to capture around: select one, or use the 3D cursor.")
            subject = context.active_object.name
        return illuminate_from_scene(SceneLight(subject=subject, **vars(capture)), output, self.force)
