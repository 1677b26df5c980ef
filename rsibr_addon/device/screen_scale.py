"""How large what is drawn on the screen has to be."""

import bpy


def ui_scale() -> float:
    """Pixels of the screen for one at Blender's own scale.

    More than 1 on screens of high resolution, and by *Resolution Scale* in Blender's preferences.
    """
    return bpy.context.preferences.system.ui_scale or 1.0  # 0 without a window
