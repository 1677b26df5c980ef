"""Name and version of what makes files with Blender's help."""

import bpy

from ..files.version import rsibr


def software() -> str:
    """Names and versions of RSIBR and Blender, as "rsibr 0.2.0, Blender 5.2.0"."""
    return f"{rsibr()}, Blender {bpy.app.version_string}"
