"""What the X screen shows, and keys, by libX11 alone.

Blender's own screenshot is black under software OpenGL, and events that it simulates end no render.

Copied beside `in_window` into the folder that Blender sees as /job.
"""

import ctypes
import struct
import zlib
from pathlib import Path

import numpy as np

ALL_PLANES = 0xFFFFFFFF
Z_PIXMAP = 2
ESCAPE = 0xFF1B
KEY_PRESS, KEY_PRESS_MASK = 2, 1


class XImage(ctypes.Structure):
    """The beginning of Xlib's structure of that name."""

    _fields_ = (
        *((name, ctypes.c_int) for name in ("width", "height", "xoffset", "format")),
        ("data", ctypes.c_void_p),
        *((name, ctypes.c_int) for name in ("byte_order", "bitmap_unit", "bitmap_bit_order", "bitmap_pad")),
        *((name, ctypes.c_int) for name in ("depth", "bytes_per_line", "bits_per_pixel")),
    )


class XKeyEvent(ctypes.Structure):
    """Xlib's structure of that name, and what fills it up to an event."""

    _fields_ = (
        *(("type", ctypes.c_int), ("serial", ctypes.c_ulong), ("send_event", ctypes.c_int)),
        ("display", ctypes.c_void_p),
        *((name, ctypes.c_ulong) for name in ("window", "root", "subwindow", "time")),
        *((name, ctypes.c_int) for name in ("x", "y", "x_root", "y_root")),
        *(("state", ctypes.c_uint), ("keycode", ctypes.c_uint), ("same_screen", ctypes.c_int)),
        ("rest", ctypes.c_long * 24),
    )


xlib = ctypes.CDLL("libX11.so.6")
xlib.XOpenDisplay.restype, xlib.XOpenDisplay.argtypes = ctypes.c_void_p, [ctypes.c_char_p]
xlib.XDefaultRootWindow.restype, xlib.XDefaultRootWindow.argtypes = ctypes.c_ulong, [ctypes.c_void_p]
xlib.XDisplayWidth.argtypes = xlib.XDisplayHeight.argtypes = [ctypes.c_void_p, ctypes.c_int]
xlib.XGetImage.restype = ctypes.POINTER(XImage)
xlib.XGetImage.argtypes = [
    *(ctypes.c_void_p, ctypes.c_ulong),
    *(ctypes.c_int, ctypes.c_int, ctypes.c_uint, ctypes.c_uint),
    *(ctypes.c_ulong, ctypes.c_int),
]
xlib.XKeysymToKeycode.restype = ctypes.c_ubyte
xlib.XKeysymToKeycode.argtypes = [ctypes.c_void_p, ctypes.c_ulong]
xlib.XQueryTree.argtypes = [
    *(ctypes.c_void_p, ctypes.c_ulong),
    *(ctypes.POINTER(ctypes.c_ulong), ctypes.POINTER(ctypes.c_ulong)),
    *(ctypes.POINTER(ctypes.POINTER(ctypes.c_ulong)), ctypes.POINTER(ctypes.c_uint)),
]
xlib.XSendEvent.argtypes = [
    *(ctypes.c_void_p, ctypes.c_ulong, ctypes.c_int, ctypes.c_long),
    ctypes.POINTER(XKeyEvent),
]
xlib.XFree.argtypes = [ctypes.c_void_p]
xlib.XCloseDisplay.argtypes = [ctypes.c_void_p]


def grab() -> np.ndarray:
    """The screen's pixels, shape (height, width, 3), 0 to 255, row 0 at the top."""
    display = xlib.XOpenDisplay(None)
    width, height = xlib.XDisplayWidth(display, 0), xlib.XDisplayHeight(display, 0)
    root = xlib.XDefaultRootWindow(display)
    image = xlib.XGetImage(display, root, 0, 0, width, height, ALL_PLANES, Z_PIXMAP)
    line = image.contents.bytes_per_line
    stored = np.frombuffer(ctypes.string_at(image.contents.data, line * height), dtype=np.uint8)
    xlib.XFree(image.contents.data)
    xlib.XFree(image)
    xlib.XCloseDisplay(display)
    return stored.reshape(height, line)[:, : 4 * width].reshape(height, width, 4)[..., 2::-1]


def press(key: int) -> None:
    """Press a key in every window, as the keyboard does."""
    display = xlib.XOpenDisplay(None)
    root, count = xlib.XDefaultRootWindow(display), ctypes.c_uint()
    unused, windows = ctypes.c_ulong(), ctypes.POINTER(ctypes.c_ulong)()
    xlib.XQueryTree(display, root, unused, unused, windows, count)
    for each in windows[: count.value]:
        code = xlib.XKeysymToKeycode(display, key)
        event = XKeyEvent(type=KEY_PRESS, window=each, root=root, keycode=code, same_screen=1)
        xlib.XSendEvent(display, each, 1, KEY_PRESS_MASK, event)
    xlib.XFree(windows)
    xlib.XCloseDisplay(display)


def save(picture: np.ndarray, path: str) -> None:
    """Write pixels, shape (height, width, 3), 0 to 255, as a PNG file."""
    height, width, _ = picture.shape
    unfiltered = np.zeros((height, 1 + 3 * width), dtype=np.uint8)
    unfiltered[:, 1:] = picture.reshape(height, -1)
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    chunks = (b"IHDR", header), (b"IDAT", zlib.compress(unfiltered.tobytes())), (b"IEND", b"")
    with Path(path).open("wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n")
        for kind, data in chunks:
            file.write(
                struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
            )
