"""Capture a material of the open file in its world."""

from pathlib import Path

import bpy

from ..rsibr_addon.core.errors import SceneError
from ..rsibr_addon.core.progress import Steps, drain
from ..rsibr_addon.job import CaptureJob
from ..rsibr_addon.tasks.capture import capture
from .reporting import reporting


class RSIBR_OT_capture_views(bpy.types.Operator):
    """Render a material in the scene's world from all around, into a map set"""  # noqa: D400  (a tooltip)

    bl_idname = "rsibr.capture_views"
    bl_label = "Capture Radiance Views"
    bl_options = {"REGISTER"}  # noqa: RUF012  (Blender reads the class)

    filepath: bpy.props.StringProperty(
        name="Map Set", description="File to write", subtype="FILE_PATH", options={"SKIP_SAVE"}
    )
    material: bpy.props.StringProperty(
        name="Material", description="Material of this file; empty for the active object's active one"
    )
    views: bpy.props.EnumProperty(
        name="Views",
        description="View directions to capture from",
        items=[(count, count, "") for count in ("12", "42", "162")],
    )
    size: bpy.props.IntProperty(
        name="Size", description="Width and height of a view in texels", default=256, min=4, max=8192
    )
    samples: bpy.props.IntProperty(name="Samples", description="Samples of Cycles a texel", default=64, min=2)
    denoise: bpy.props.BoolProperty(
        name="Denoise", description="Denoise each view; good for rough materials, bad for mirrors"
    )
    seed: bpy.props.IntProperty(name="Seed", description="Seed of Cycles' noise", min=0)
    force: bpy.props.BoolProperty(name="Replace", description="Replace the file if it exists")

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Capture at a stretch."""
        with reporting(self):
            path = drain(capture(self._job(context)))
            self.report({"INFO"}, f"Captured {path}")
            return {"FINISHED"}
        return {"CANCELLED"}

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask for a file, or capture one view per tick of a timer when it is given."""
        if not self.filepath:
            context.window_manager.fileselect_add(self)
            return {"RUNNING_MODAL"}
        with reporting(self):
            self._steps: Steps[Path] = capture(self._job(context))
            self._timer = context.window_manager.event_timer_add(0.01, window=context.window)
            context.window_manager.modal_handler_add(self)
            return {"RUNNING_MODAL"}
        return {"CANCELLED"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Take a step; Escape ends the capture, which keeps its finished views."""
        if event.type == "ESC":
            self.report({"WARNING"}, "Capture interrupted; started again, it goes on")
            self.cancel(context)
            return {"CANCELLED"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        result = {"CANCELLED"}
        try:
            with reporting(self):
                result = self._step(context)
        finally:
            if result != {"RUNNING_MODAL"}:
                self.cancel(context)
        return result

    def cancel(self, context: bpy.types.Context) -> None:
        """Stop; Blender calls this too, when it closes the window or the file."""
        self._steps.close()
        context.window_manager.event_timer_remove(self._timer)
        context.workspace.status_text_set(None)

    def _step(self, context: bpy.types.Context) -> set[str]:
        try:
            progress = next(self._steps)
        except StopIteration as end:
            self.report({"INFO"}, f"Captured {end.value}")
            return {"FINISHED"}
        context.workspace.status_text_set(f"{progress.what} (Esc: interrupt)")
        return {"RUNNING_MODAL"}

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
