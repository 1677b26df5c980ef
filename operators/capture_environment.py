"""Capture the light around an object or a point of the open file."""

from pathlib import Path

import bpy

from ..rsibr_addon.core.errors import SceneError
from ..rsibr_addon.core.progress import Steps
from ..rsibr_addon.tasks.light.scene import LARGEST, SMALLEST, SceneLight, illuminate_from_scene
from ..rsibr_addon.tasks.light.world import illuminate_from_world
from .file_properties import file_path
from .stepwise import Stepwise
from .use_picture import take_picture


class RSIBR_OT_capture_environment(Stepwise, bpy.types.Operator):
    """Render the light that arrives somewhere into a latitude-longitude picture"""  # noqa: D400  (a tooltip)

    bl_idname = "rsibr.capture_environment"
    bl_label = "Capture Environment"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012  (Blender reads the class)

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
            ("WORLD", "World", "The world alone"),
        ],
    )
    size = bpy.props.IntProperty(
        name="Size",
        description="Width of the picture in texels, even; it is half as high",
        default=1024,
        min=SMALLEST,
        max=LARGEST,
        step=2,
    )
    samples = bpy.props.IntProperty(
        name="Samples", description="Samples of Cycles a pixel; not of the world alone", default=128, min=1
    )
    faces = bpy.props.BoolProperty(
        name="Six Faces", description="Render the six faces of a cube instead of a panorama"
    )
    denoise = bpy.props.BoolProperty(name="Denoise", description="Denoise what is rendered")
    seed = bpy.props.IntProperty(name="Seed", description="Seed of Cycles' noise", min=0)
    load_image = bpy.props.BoolProperty(
        name="Load", description="Load the picture into this file afterwards", default=True
    )
    use = bpy.props.BoolProperty(
        name="Use", description="Bake with this light from now on", options={"SKIP_SAVE"}
    )

    interrupted = "Capture interrupted; nothing was written"

    def work(self, context: bpy.types.Context) -> Steps[Path]:
        """Capture, one render per step."""
        output = Path(bpy.path.abspath(self.filepath))
        if self.source == "WORLD":
            return illuminate_from_world(None, self.size, output, self.force)
        return illuminate_from_scene(self._light(context), output, self.force)

    def finish(self, result: Path) -> None:
        """Load the picture and choose it if asked to, and say where it is."""
        take_picture(result, self.load_image, self.use)
        self.report({"INFO"}, f"Captured {result}")

    def _light(self, context: bpy.types.Context) -> SceneLight:
        subject = None
        if self.source == "OBJECT":
            if context.active_object is None:
                raise SceneError("There is no object to capture around: select one, or use the 3D cursor.")
            subject = context.active_object.name
        return SceneLight(
            size=self.size,
            samples=self.samples,
            subject=subject,
            faces=self.faces,
            denoise=self.denoise,
            seed=self.seed,
        )
