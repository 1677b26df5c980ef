"""Functions that Blender calls when something has happened."""

from collections.abc import Callable, Mapping
from contextlib import ExitStack

import bpy


def add_handlers(handlers: Mapping[str, Callable[..., None]], undo: ExitStack) -> None:
    """Have Blender call functions from now on.

    Parameters
    ----------
    handlers : mapping of str to callable
        Name of a list of `bpy.app.handlers` -> what is called.
    undo : ExitStack
        Takes what ends it.
    """
    for name, function in handlers.items():
        called = getattr(bpy.app.handlers, name)
        called.append(function)
        undo.callback(called.remove, function)
