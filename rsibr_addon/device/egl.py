"""A check whether Linux's graphics drivers give a context that Blender can use.

Blender crashes with a segmentation fault where they do not, so we ask before, in Blender's own way.
"""

import ctypes
import functools
from ctypes import byref, c_int, c_void_p

from ..core.errors import DeviceError

OPENGL_API = 0x30A2
PLATFORM_SURFACELESS = 0x31DD
RENDERABLE_TYPE, OPENGL_BIT = 0x3040, 0x0008
SURFACE_TYPE, PBUFFER_BIT = 0x3033, 0x0001
MAJOR_VERSION, MINOR_VERSION = 0x3098, 0x30FB
PROFILE_MASK, CORE_PROFILE_BIT = 0x30FD, 0x0001
NONE = 0x3038

OLDEST_OPENGL = 4, 3
"""Oldest version of OpenGL that Blender works with."""


@functools.cache
def check_drivers() -> None:
    """Refuse to continue without a driver; a driver that was found is not looked for again.

    Raises
    ------
    OSError
        EGL is not installed.
    DeviceError
        No driver gives such a context; the message names only what is missing.
    """
    egl = ctypes.CDLL("libEGL.so.1")
    for name in ("eglGetDisplay", "eglGetPlatformDisplay", "eglCreateContext"):
        getattr(egl, name).restype = c_void_p
    display = c_void_p(egl.eglGetDisplay(None))
    if not egl.eglInitialize(display, None, None):
        # No screen: drivers can draw without one
        display = c_void_p(egl.eglGetPlatformDisplay(PLATFORM_SURFACELESS, None, None))
        if not egl.eglInitialize(display, None, None):
            raise DeviceError("EGL has no display")
    config, count = c_void_p(), c_int()
    wanted = (c_int * 5)(RENDERABLE_TYPE, OPENGL_BIT, SURFACE_TYPE, PBUFFER_BIT, NONE)
    version = (MAJOR_VERSION, OLDEST_OPENGL[0], MINOR_VERSION, OLDEST_OPENGL[1])
    attributes = (c_int * 7)(*version, PROFILE_MASK, CORE_PROFILE_BIT, NONE)
    egl.eglBindAPI(OPENGL_API)
    egl.eglChooseConfig(display, wanted, byref(config), 1, byref(count))
    context = c_void_p(egl.eglCreateContext(display, config, None, attributes))
    if not context:
        raise DeviceError("EGL has no OpenGL {}.{}".format(*OLDEST_OPENGL))
    egl.eglDestroyContext(display, context)
