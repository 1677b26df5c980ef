"""The file that the active object is shaded from: whether it is packed, gone or another; and what to do."""

from pathlib import Path
from typing import Any

import bpy

from ..files.kinds.registry import STORED
from ..host.map_sets import is_packed
from ..tasks.queue.bake_request import plain_name
from ..tasks.report.facts import map_set_content
from .sentences import BUTTON_WIDTH, tell


def draw_file(layout: bpy.types.UILayout, item: bpy.types.Object, path: Path, width: int) -> None:
    """Show the name of an object's map set, and the button that packs or unpacks it.

    Parameters
    ----------
    layout : bpy.types.UILayout
    item : bpy.types.Object
    path : Path
        A whole map set.
    width : int
        See `panel_width`.
    """
    packed = is_packed(item.rsibr)
    row = layout.row(align=True)
    tell(row, plain_name(path), width - BUTTON_WIDTH, icon="FILE_IMAGE")
    if packed:
        row.operator("rsibr.unpack", text="", icon="PACKAGE")
    else:
        row.operator("rsibr.pack", text="", icon="UGLYPACKAGE")


def draw_painting(layout: bpy.types.UILayout, item: bpy.types.Object, header: dict[str, Any]) -> None:
    """Offer to paint an object's tables; or show what is painted, and the buttons that end it.

    Parameters
    ----------
    layout : bpy.types.UILayout
    item : bpy.types.Object
    header : dict
        The description of its map set.
    """
    if not item.rsibr.painted:
        if STORED[header["kind"]].painted:
            layout.operator("rsibr.edit_as_images", icon="BRUSHES_ALL")
        return
    column = layout.column(align=True)
    for each in item.rsibr.painted:
        column.prop(each, "image", text=each.name.capitalize())
    row = layout.row(align=True)
    row.operator("rsibr.save_back", icon="FILE_TICK")
    row.operator("rsibr.discard_paint", icon="X")


def draw_change(layout: bpy.types.UILayout, item: bpy.types.Object, path: Path, width: int) -> None:
    """Show whether an object's map set holds something else than when it was chosen, and what helps.

    Parameters
    ----------
    layout : bpy.types.UILayout
    item : bpy.types.Object
    path : Path
        A whole map set.
    width : int
        See `panel_width`.
    """
    if item.rsibr.content and not item.rsibr.painted and item.rsibr.content != map_set_content(path):
        tell(
            layout,
            f"{path.name} holds something else than when it was chosen: accept that, find the file "
            "that it was, or bake it again.",
            width,
        )
        layout.operator("rsibr.accept", icon="CHECKMARK")
        draw_remedies(layout)


def draw_remedies(layout: bpy.types.UILayout) -> None:
    """Offer what helps when a map set is not there."""
    row = layout.row(align=True)
    row.operator("rsibr.assign", text="Find...", icon="FILEBROWSER")
    row.operator("rsibr.bake_again", icon="FILE_REFRESH")
