"""The sidebars of all 3D viewports."""

import bpy


def redraw_sidebars() -> None:
    """Redraw the panels in all sidebars."""
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                for region in area.regions:
                    if region.type == "UI":
                        region.tag_redraw()
