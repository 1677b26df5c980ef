"""Blender's data for live light: an object's place, and the viewport that shows its surroundings."""

from collections.abc import Iterator
from contextlib import contextmanager
from operator import attrgetter

import bpy
import numpy as np

from ..core.conventions import Array

_SHADINGS = ("SOLID", "MATERIAL", "RENDERED")
"""Shadings of viewports, in ascending order of nearness to real light."""

_SHADING = [each for each in bpy.types.View3DShading.bl_rna.properties if each.type != "POINTER"]
_COLOURS = {each.identifier for each in _SHADING if getattr(each, "is_array", False)}
_settings_of = attrgetter(*(each.identifier for each in _SHADING if each.identifier not in _COLOURS))
_colours_of = attrgetter(*_COLOURS)


def live_name(item: bpy.types.Object) -> str:
    """A name for the light around an object, another for other settings, that no file can have."""
    live = item.rsibr.live
    return f"live\0{item.session_uid}\0{live.size}\0{live.degree if live.mips else 'kernels'}"


def is_live_name(name: str) -> bool:
    """Whether a name is from `live_name`."""
    return name.startswith("live\0")


def points_of(item: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> Array:
    """Outer points of an object: its vertices, or the corners of its bounding box.

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


def is_readable(space: bpy.types.SpaceView3D) -> bool:
    """Whether what a viewport shows can be rendered once more: Cycles' pictures and other engines' cannot."""
    return nearness(space, bpy.context.engine) >= 0


def appearance_of(space: bpy.types.SpaceView3D) -> tuple[object, ...]:
    """All settings of a viewport's shading, for comparison with earlier ones."""
    shading = space.shading
    colours = map(tuple, _colours_of(shading))
    return _settings_of(shading), *colours, space.clip_start, space.clip_end, bpy.context.engine


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


def can_hide(item: bpy.types.Object, layer: bpy.types.ViewLayer) -> bool:
    """Whether `hidden` takes an object: one that the view layer has and shows, none of a background scene."""
    return bool(item.visible_get(view_layer=layer))


@contextmanager
def hidden(item: bpy.types.Object, layer: bpy.types.ViewLayer) -> Iterator[None]:
    """Within, an object is hidden in a view layer, with the instances that it makes, and casts no shadow.

    Both ends update the view layer, which tells its handlers of no object, and evaluates no mesh. The last
    one also updates what other windows show, as Blender has all scenes look at an object's visibility anew.
    """
    selected = item.select_get(view_layer=layer)
    try:
        item.hide_set(True, view_layer=layer)
        layer.update()
        yield
    finally:
        item.hide_set(False, view_layer=layer)
        item.select_set(selected, view_layer=layer)  # what is hidden is not selected
        layer.update()
        for window in bpy.context.window_manager.windows:
            window.view_layer.update()


def nearness(space: bpy.types.SpaceView3D, engine: str) -> int:
    """How near a viewport's shading comes to real light; -1 where what it shows cannot be rendered once more.

    Parameters
    ----------
    space : bpy.types.SpaceView3D
    engine : str
        Of its scene. Pictures by Cycles and by engines that are not Blender's own do not count.
    """
    kind = space.shading.type
    foreign = kind == "RENDERED" and not engine.startswith(("BLENDER_EEVEE", "BLENDER_WORKBENCH"))
    return -1 if foreign or kind not in _SHADINGS else _SHADINGS.index(kind)
