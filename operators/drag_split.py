"""Move the line between previews and Blender's own shading."""

import bpy


class RSIBR_OT_drag_split(bpy.types.Operator):
    """Move the line right of which Blender's own shading shows; click to set it"""  # noqa: D400  (a tooltip)

    bl_idname = "rsibr.drag_split"
    bl_label = "Drag the Line"
    bl_options = {"REGISTER"}  # noqa: RUF012  (Blender reads the class)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether there is a viewport to move it in."""
        return context.area is not None and context.area.type == "VIEW_3D"

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Follow the mouse from now on."""
        self._before = context.window_manager.rsibr_view.line
        self._region = next(region for region in context.area.regions if region.type == "WINDOW")
        context.window_manager.rsibr_view.split = True
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Move the line; Escape and the right button put it back."""
        settings = context.window_manager.rsibr_view
        match event.type:
            case "MOUSEMOVE":
                settings.line = (event.mouse_x - self._region.x) / self._region.width
            case "LEFTMOUSE" | "RET":
                return {"FINISHED"}
            case "ESC" | "RIGHTMOUSE":
                settings.line = self._before
                return {"CANCELLED"}
        return {"RUNNING_MODAL"}
