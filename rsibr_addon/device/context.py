"""Blender's graphics context, in a window or without one."""

import ctypes
import sys

import bpy
import gpu

from ..core.errors import DeviceError


def ensure_context() -> None:
    """Make Blender's `gpu` module usable, also in a background Blender and in the bpy module.

    Raises
    ------
    DeviceError
        There is no graphics driver that Blender can use.
    """
    if not bpy.app.background:
        return
    try:
        if sys.platform == "linux":
            ctypes.CDLL("libEGL.so.1")  # Without it gpu.init() ends the process.
        gpu.init()
    except (OSError, SystemError, RuntimeError) as error:
        raise DeviceError(
            f"Blender found no graphics driver ({error}): install one; Mesa's software driver "
            f"(Debian: libegl1 and libgl1-mesa-dri) is enough."
        ) from error
