"""An entry in Blender's menu File > Export."""

from contextlib import ExitStack

import bpy


def start(undo: ExitStack) -> None:
    """Add the entry.

    Parameters
    ----------
    undo : ExitStack
        Takes what removes it.
    """
    bpy.types.TOPBAR_MT_file_export.append(_draw)
    undo.callback(bpy.types.TOPBAR_MT_file_export.remove, _draw)


def _draw(menu: bpy.types.Menu, context: bpy.types.Context) -> None:
    menu.layout.operator("rsibr.export_ktx2", text="Reflection Maps (.ktx2)")
