"""What a 3D viewport shows: the surfaces of a scene, instances and all, and the view on them."""

from collections.abc import Iterator
from dataclasses import dataclass

import bpy
import numpy as np

from ..core.conventions import Array
from .live_light import live_name
from .map_sets import planned_path
from .world_light import AS_IT_IS, WorldLight, world_light

UNSHADED = ("WIRE", "BOUNDS")
"""Ways to display an object without its surface."""

type Layer = tuple[int, str]
"""A view layer: its scene, and its name."""


@dataclass(frozen=True, eq=False)
class Surface:
    """A mesh as it stands in a scene.

    Attributes
    ----------
    item : bpy.types.Object
        Whose surface it is: the artist's own object, not its evaluated copy.
    shown_by : bpy.types.Object
        That whose visibility counts: `item`, or what makes instances of it.
    mesh : int
        Equal for equal meshes; another number whenever Blender evaluates a mesh again.
    matrix : ndarray, shape (4, 4)
        World from object coordinates.
    """

    item: bpy.types.Object
    shown_by: bpy.types.Object
    mesh: int
    matrix: Array


@dataclass(frozen=True)
class Side:
    """A part of a viewport that shows previews.

    Attributes
    ----------
    other : bool
        Whether objects show their other look.
    left, right : float
        Where it begins and ends, as parts of the width.
    difference : float
        Where it is not 0, the difference of both looks is shown, as bright as can be at that number.
    """

    other: bool
    left: float
    right: float
    difference: float = 0.0


@dataclass(frozen=True)
class View:
    """What is looked at, and through which area.

    Attributes
    ----------
    scene : bpy.types.Scene
    layer : Layer
        The view layer that is shown.
    depsgraph : bpy.types.Depsgraph
        Of that layer, evaluated.
    space : bpy.types.SpaceView3D
    """

    scene: bpy.types.Scene
    layer: Layer
    depsgraph: bpy.types.Depsgraph
    space: bpy.types.SpaceView3D

    @property
    def shaded(self) -> bool:
        """Whether surfaces are drawn, and not wires alone."""
        return bool(self.space.shading.type != "WIREFRAME")

    @property
    def has_depth(self) -> bool:
        """Whether Blender leaves its surfaces' depths to those who draw later."""
        return bool(self.space.shading.type == "SOLID" or self.space.overlay.show_overlays)

    @property
    def sides(self) -> tuple[Side, ...]:
        """What is shown from left to right; the rest is Blender's."""
        settings = bpy.context.window_manager.rsibr_view
        if not settings.split:
            return (Side(other=False, left=0.0, right=1.0),)
        first = Side(other=False, left=0.0, right=settings.line)
        difference = settings.difference if settings.beyond == "difference" else 0.0
        second = Side(other=True, left=settings.line, right=1.0, difference=difference)
        return (first,) if settings.beyond == "blender" else (first, second)

    def light_of(self, item: bpy.types.Object) -> WorldLight:
        """What the world makes of the environment of an object's map set: nothing, unless it is followed."""
        follows = item.rsibr.follow_world and not item.rsibr.live.on
        followed = world_light(self.scene.world) if follows else None
        return followed or AS_IT_IS


def current_view() -> View:
    """The view that is being drawn."""
    context = bpy.context
    scene, layer = context.scene, context.view_layer
    return View(scene, (scene.session_uid, layer.name), layer.depsgraph, context.space_data)


def shown_layers() -> set[Layer]:
    """The view layers that any window shows."""
    windows = bpy.context.window_manager.windows
    return {(window.scene.session_uid, window.view_layer.name) for window in windows}


def map_set_of(item: bpy.types.Object) -> str:
    """Path of the file that is to shade an object; empty for none, also when it is not to be shown.

    In live light, `live_light.live_name` instead.
    """
    settings = item.rsibr
    if settings.show and settings.live.on:
        return live_name(item)
    return planned_path(settings) if settings.show else ""


def is_wanted() -> bool:
    """Whether any object of the file is to be shaded from a map set."""
    return any(map(map_set_of, bpy.data.objects))


def surfaces(depsgraph: bpy.types.Depsgraph) -> Iterator[tuple[Surface, bpy.types.Object]]:
    """Every surface that the view layer shows.

    Parameters
    ----------
    depsgraph : bpy.types.Depsgraph
        Evaluated.

    Yields
    ------
    surface : Surface
    evaluated : bpy.types.Object
        What `meshes.mesh_from_object` makes its mesh from; only until the next one is asked for.

    Notes
    -----
    Curves, texts, metaballs and what geometry nodes make are there too: Blender lists an instance of
    type mesh for each.
    """
    for instance in depsgraph.object_instances:
        evaluated = instance.object
        if evaluated.type != "MESH" or not instance.show_self or evaluated.display_type in UNSHADED:
            continue
        item = evaluated.original
        shown_by = instance.parent.original if instance.is_instance else item
        yield Surface(item, shown_by, evaluated.data.session_uid, np.array(instance.matrix_world)), evaluated
