"""Capture a material of the open file in its world."""

from pathlib import Path

import bpy

from ..rsibr_addon.core.errors import SceneError
from ..rsibr_addon.core.progress import Steps
from ..rsibr_addon.job import CaptureJob
from ..rsibr_addon.tasks.methods.radiance_views import capture
from .stepwise import Stepwise


class RSIBR_OT_capture_views(Stepwise, bpy.types.Operator):
    """Render a material in the scene's world from all around, into a map set"""  # noqa: D400  (a tooltip)

    bl_idname = "rsibr.capture_views"
    bl_label = "Capture Radiance Views"
    bl_options = {"REGISTER"}  # noqa: RUF012  (Blender reads the class)

    filepath = bpy.props.StringProperty(
        name="Map Set",
        description="File to write",
        subtype="FILE_PATH",
        options={"SKIP_SAVE", "PATH_SUPPORTS_BLEND_RELATIVE"},
    )
    material = bpy.props.StringProperty(
        name="Material", description="Material of this file; empty for the active object's active one"
    )
    views = bpy.props.EnumProperty(
        name="Views",
        description="View directions to capture from",
        items=[(count, count, "") for count in ("12", "42", "162")],
    )
    size = bpy.props.IntProperty(
        name="Size", description="Width and height of a view in texels", default=256, min=4, max=8192
    )
    samples = bpy.props.IntProperty(
        name="Samples", description="Samples of Cycles a texel", default=64, min=2
    )
    denoise = bpy.props.BoolProperty(
        name="Denoise", description="Denoise each view; good for rough materials, bad for mirrors"
    )
    seed = bpy.props.IntProperty(name="Seed", description="Seed of Cycles' noise", min=0)
    force = bpy.props.BoolProperty(name="Replace", description="Replace the file if it exists")

    interrupted = "Capture interrupted; started again, it goes on"

    def work(self, context: bpy.types.Context) -> Steps[Path]:
        """Capture, one view per step."""
        return capture(self._job(context))

    def finish(self, result: Path) -> None:
        """Say where it is."""
        self.report({"INFO"}, f"Captured {result}")

    def _job(self, context: bpy.types.Context) -> CaptureJob:
        item = context.active_object
        material = self.material or (item and item.active_material and item.active_material.name)
        if not material:
            raise SceneError("There is no material to capture: select an object that has one.")
        return CaptureJob(
            environment=None,
            material=f":{material}",
            output=bpy.path.abspath(self.filepath),
            views=int(self.views),
            size=self.size,
            samples=self.samples,
            denoise=self.denoise,
            seed=self.seed,
            force=self.force,
        )
