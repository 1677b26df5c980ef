"""The 3D viewports of all windows, and their sidebars."""

from collections.abc import Iterator

import bpy


def redraw_sidebars() -> None:
    """Redraw the panels in all sidebars."""
    for area in _viewports():
        for region in area.regions:
            if region.type == "UI":
                region.tag_redraw()


def redraw_viewports() -> None:
    """Redraw all viewports, sidebars and all."""
    for area in _viewports():
        area.tag_redraw()


def _viewports() -> Iterator[bpy.types.Area]:
    for window in bpy.context.window_manager.windows:
        yield from (area for area in window.screen.areas if area.type == "VIEW_3D")
