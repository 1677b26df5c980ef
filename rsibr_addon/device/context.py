"""Blender's graphics context, in a window or without one."""

import sys

import bpy
import gpu

from ..core.errors import DeviceError
from .egl import check_drivers


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
            check_drivers()
        gpu.init()
    except (DeviceError, OSError, SystemError, RuntimeError) as error:
        raise DeviceError(
            f"Blender found no graphics driver ({error}): {_limit()}install one; Mesa's software driver "
            f"(Debian: libegl1 and libgl1-mesa-dri) is enough."
        ) from error


def has_driver() -> bool:
    """Whether a background Blender can make a context: where it tries in vain, it crashes."""
    try:
        if sys.platform == "linux":
            check_drivers()
    except (DeviceError, OSError):
        return False
    return True


def _limit() -> str:
    """The advice where drivers may exist but find too little memory."""
    if sys.platform == "win32":
        return ""
    import resource

    limit = resource.getrlimit(resource.RLIMIT_AS)[0]
    if limit == resource.RLIM_INFINITY:
        return ""
    return f"raise the limit of {limit / 1e9:.1f} GB on its addresses (ulimit -v), or "
