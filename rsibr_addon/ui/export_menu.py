"""Entries in Blender's menu File > Export."""

from contextlib import ExitStack

import bpy

from ..tasks.export.formats import FORMATS


def start(undo: ExitStack) -> None:
    """Add an entry for each format, one for engines, and one for web pages.

    Parameters
    ----------
    undo : ExitStack
        Takes what removes them.
    """
    bpy.types.TOPBAR_MT_file_export.append(_draw)
    undo.callback(bpy.types.TOPBAR_MT_file_export.remove, _draw)


def _draw(menu: bpy.types.Menu, context: bpy.types.Context) -> None:
    for name, each in FORMATS.items():
        menu.layout.operator(f"rsibr.export_{name}", text=f"{each.label} ({each.suffix})")
    menu.layout.operator("rsibr.export_for_engine", text="Reflection Maps for an Engine")
    menu.layout.operator("rsibr.export_page", text="Reflection Maps as a Web Page (.html)")
