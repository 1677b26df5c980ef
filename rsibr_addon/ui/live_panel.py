"""Live light, below what shades the active object."""

import bpy

from .sidebar import InSidebar


class RSIBR_PT_live(InSidebar, bpy.types.Panel):
    """Shade the active object from its surroundings, as the viewport shows them"""  # noqa: D400  (a tooltip)

    bl_label = "Live Light"
    bl_parent_id = "RSIBR_PT_look"
    bl_options = {"DEFAULT_CLOSED"}  # noqa: RUF012  (Blender reads the class)

    def draw_header(self, context: bpy.types.Context) -> None:
        """Show the switch."""
        self.layout.prop(context.object.rsibr.live, "on", text="")

    def draw(self, context: bpy.types.Context) -> None:
        """Show the light's resolution, and the time that a frame may spend on it."""
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        live = context.object.rsibr.live
        self.layout.prop(live, "size")
        self.layout.prop(live, "budget")
        header, opened = self.layout.panel("RSIBR_live_advanced", default_closed=True)
        header.label(text="Advanced")
        if opened:
            opened.prop(live, "mips")
            degree = opened.column()
            degree.active = live.mips
            degree.prop(live, "degree")
