"""What live light takes from Blender: where an object stands, and which viewport shows its surroundings."""

from collections.abc import Iterator
from contextlib import contextmanager

import bpy
import numpy as np

from ..core.conventions import Array

_SHADINGS = ("SOLID", "MATERIAL", "RENDERED")
"""Shadings of viewports, those that come nearer to light last."""


def live_name(item: bpy.types.Object) -> str:
    """A name for the light around an object, which no file has; another for another size.

    Parameters
    ----------
    item : bpy.types.Object

    Returns
    -------
    str
    """
    return f"live\0{item.session_uid}\0{item.rsibr.live.size}"


def is_live_name(name: str) -> bool:
    """Whether a name is one of `live_name`."""
    return name.startswith("live\0")


def points_of(item: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> Array:
    """Points that an object reaches: its vertices, or the corners of the box about it.

    Parameters
    ----------
    item : bpy.types.Object
    depsgraph : bpy.types.Depsgraph
        Evaluated.

    Returns
    -------
    ndarray, shape (n, 3), float64
        In object coordinates.
    """
    evaluated = item.evaluated_get(depsgraph)
    if evaluated.type != "MESH" or not evaluated.data.vertices:
        return np.array(evaluated.bound_box)
    positions = np.empty(3 * len(evaluated.data.vertices), dtype=np.float32)
    evaluated.data.vertices.foreach_get("co", positions)
    return positions.reshape(-1, 3).astype(np.float64)


def shows_surroundings(space: bpy.types.SpaceView3D) -> bool:
    """Whether surroundings are to be rendered as a viewport shows them.

    Parameters
    ----------
    space : bpy.types.SpaceView3D

    Returns
    -------
    bool
        False where another viewport comes nearer to light, and where Cycles or another engine that is not
        Blender's own draws.
    """
    windows = bpy.context.window_manager.windows
    spaces = [
        area.spaces.active for window in windows for area in window.screen.areas if area.type == "VIEW_3D"
    ]
    return _nearness(space) >= max(0, *map(_nearness, spaces))


@contextmanager
def bare(space: bpy.types.SpaceView3D) -> Iterator[None]:
    """Within, a viewport has no overlays."""
    shown = space.overlay.show_overlays
    if shown:
        space.overlay.show_overlays = False
    try:
        yield
    finally:
        if shown:
            space.overlay.show_overlays = True


def _nearness(space: bpy.types.SpaceView3D) -> int:
    kind = space.shading.type
    foreign = kind == "RENDERED" and not bpy.context.engine.startswith(("BLENDER_EEVEE", "BLENDER_WORKBENCH"))
    return -1 if foreign or kind not in _SHADINGS else _SHADINGS.index(kind)
