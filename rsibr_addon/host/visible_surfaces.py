"""The content of a 3D viewport: the surfaces of a scene, with instances, and the view on them."""

from collections.abc import Collection, Iterator
from dataclasses import dataclass

import bpy
import numpy as np

from ..core.conventions import Array
from ..core.pictures.matte import PictureFrame
from .live_light import live_name, nearness
from .map_sets import planned_path
from .world_light import AS_IT_IS, WorldLight, follows_world, world_light

UNSHADED = ("WIRE", "BOUNDS")
"""Ways to display an object without its surface, in viewports."""

RENDER_ENGINE = "RSIBR"
"""Blender's name of our render engine."""

Layer = tuple[int, str]
"""A view layer: its scene, and its name."""


@dataclass(frozen=True, eq=False)
class Surface:
    """A mesh and its place in a scene.

    Attributes
    ----------
    item : bpy.types.Object
        The surface's object: the artist's own, not its evaluated copy, but in a render. It may be deleted
        before the scene is looked at anew, and then it has no properties any more.
    number : int
        The `session_uid` of the artist's own object; a render's copy has 0.
    shown_by : bpy.types.Object
        The object whose visibility counts: `item`, or one that makes instances of it.
    mesh : int
        Number of the mesh: equal for equal meshes, and new whenever Blender evaluates a mesh again.
    matrix : ndarray, shape (4, 4)
        World from object coordinates.
    path : str
        The file that shades it, see `map_set_of`; empty for none.
    in_world : bool
        Whether that is the world's own, as the object has none.
    follows : bool
        Whether what shades it is turned and scaled as the world is: see `follows_world`.
    """

    item: bpy.types.Object
    number: int
    shown_by: bpy.types.Object
    mesh: int
    matrix: Array
    path: str
    in_world: bool = False
    follows: bool = False

    @property
    def is_instance(self) -> bool:
        """Whether another object makes it."""
        return bool(self.shown_by != self.item)


@dataclass(frozen=True)
class Side:
    """A part of a viewport that shows previews.

    Attributes
    ----------
    other : bool
        Whether objects show their other look.
    left, right : float
        Begin and end, as parts of the width.
    difference : float
        If it is not 0, a difference is shown, brightest at this number: that of both looks, or
    from_blender : bool
        that of the first look from Blender's own shading.
    """

    other: bool
    left: float
    right: float
    difference: float = 0.0
    from_blender: bool = False


@dataclass(frozen=True)
class View:
    """The view that a viewport shows, and its area.

    Attributes
    ----------
    scene : bpy.types.Scene
    layer : Layer
        The view layer that is shown.
    depsgraph : bpy.types.Depsgraph
        The layer's dependency graph, evaluated.
    space : bpy.types.SpaceView3D
    """

    scene: bpy.types.Scene
    layer: Layer
    depsgraph: bpy.types.Depsgraph
    space: bpy.types.SpaceView3D

    @property
    def shaded(self) -> bool:
        """Whether surfaces are drawn, not only wires."""
        return bool(self.space.shading.type != "WIREFRAME")

    @property
    def draws_in_front(self) -> bool:
        """Whether Blender draws objects that are *In Front* over all others."""
        return bool(self.space.shading.type == "SOLID")

    @property
    def shades_all(self) -> bool:
        """Whether objects without a map set are shaded too, from the world's."""
        return bool(self.space.shading.type == "RENDERED" and self.scene.render.engine == RENDER_ENGINE)

    @property
    def content(self) -> tuple[Layer, bool]:
        """Equal for views that show the same surfaces, and shade the same of them."""
        return self.layer, self.shades_all

    def shows(self, surface: Surface) -> bool:
        """Whether a surface is not hidden."""
        return _shows(self.space, surface.shown_by, self.depsgraph)

    def has_shadow_of(self, surface: Surface) -> bool:
        """Whether a surface casts shadows."""
        return bool(surface.item.visible_shadow) and self.shows(surface)

    @property
    def has_depth(self) -> bool:
        """Whether Blender leaves its surfaces' depths for later drawing.

        Where all objects are shaded, its depths would hide what is seen through holes: they know of no alpha.
        """
        drawn = self.space.shading.type == "SOLID" or self.space.overlay.show_overlays
        return bool(drawn) and not self.shades_all

    @property
    def sides(self) -> tuple[Side, ...]:
        """The parts with previews from left to right; Blender draws the rest."""
        settings = bpy.context.window_manager.rsibr_view
        if not settings.split:
            return (Side(other=False, left=0.0, right=1.0),)
        first = Side(other=False, left=0.0, right=settings.line)
        difference = settings.difference if settings.beyond == "difference" else 0.0
        from_blender = difference > 0.0 and settings.compared == "blender"
        second = Side(not from_blender, settings.line, 1.0, difference, from_blender)
        return (first,) if settings.beyond == "blender" else (first, second)

    @property
    def matrices(self) -> tuple[Array, Array]:
        """From world to eye coordinates, and on to the picture's, each of shape (4, 4)."""
        seen = bpy.context.region_data
        return np.array(seen.view_matrix), np.array(seen.window_matrix)

    @property
    def size(self) -> tuple[int, int]:
        """Width and height in pixels."""
        return bpy.context.region.width, bpy.context.region.height

    @property
    def picture_frame(self) -> PictureFrame:
        """What a picture behind all objects fills: the camera's frame, or a view that is not through one."""
        (_, projection), (width, height) = self.matrices, self.size
        camera = (self.space.camera if self.space.use_local_camera else None) or self.scene.camera
        if bpy.context.region_data.view_perspective != "CAMERA" or not camera or camera.type != "CAMERA":
            return PictureFrame(projection, width / height)
        render = self.scene.render
        return camera_frame(camera, self.depsgraph, (render.resolution_x, render.resolution_y))

    @property
    def number(self) -> int:
        """Tells viewports apart."""
        return int(bpy.context.region.as_pointer())

    @property
    def world_light(self) -> WorldLight:
        """The world's turn and strength, as far as its map set does not hold them."""
        return world_light(self.scene.world) or AS_IT_IS


def camera_frame(
    camera: bpy.types.Object, depsgraph: bpy.types.Depsgraph, resolution: tuple[int, int]
) -> PictureFrame:
    """The frame of a camera's pictures, of so many pixels."""
    render, (width, height) = depsgraph.scene.render, resolution
    wide, high = render.pixel_aspect_x, render.pixel_aspect_y
    projection = camera.calc_matrix_camera(depsgraph, x=width, y=height, scale_x=wide, scale_y=high)
    return PictureFrame(np.array(projection), width * wide / (height * high))


def current_view() -> View:
    """The view that is being drawn."""
    context = bpy.context
    return View(context.scene, layer_of(context), context.view_layer.depsgraph, context.space_data)


def layer_of(shows: bpy.types.Context | bpy.types.Window) -> Layer:
    """The view layer that a context or a window shows."""
    return shows.scene.session_uid, shows.view_layer.name


def shown_layers() -> dict[Layer, bpy.types.Window]:
    """The view layers that windows show, each with one of them."""
    return {layer_of(window): window for window in bpy.context.window_manager.windows}


def renders_surroundings(
    space: bpy.types.SpaceView3D, item: bpy.types.Object, layers: Collection[Layer]
) -> bool:
    """Whether the light around an object is rendered with a viewport's shading.

    Parameters
    ----------
    space : bpy.types.SpaceView3D
    item : bpy.types.Object
        Whose visibility counts.
    layers : collection of Layer
        The view layers that have it.

    Returns
    -------
    bool
        True for at most one viewport of all windows: the first of those that show the object and come
        nearest to real light.
    """
    spaces = {
        area.spaces.active: nearness(area.spaces.active, window.scene.render.engine)
        for window in bpy.context.window_manager.windows
        if layer_of(window) in layers
        for area in window.screen.areas
        if area.type == "VIEW_3D" and _shows(area.spaces.active, item, window.view_layer.depsgraph)
    }
    return spaces.get(space, -1) >= 0 and max(spaces, key=spaces.__getitem__) == space


def _shows(space: bpy.types.SpaceView3D, item: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> bool:
    if space.use_local_collections:  # which evaluated copies alone know of
        item = item.evaluated_get(depsgraph)
    return bool(item.visible_in_viewport_get(space))


def map_set_of(item: bpy.types.Object) -> str:
    """Path of the file that shades an object; empty if there is none or previews are off.

    In live light, `live_light.live_name`.
    """
    settings = item.rsibr
    if settings.show and settings.live.on:
        return live_name(item)
    return planned_path(settings) if settings.show else ""


def is_wanted() -> bool:
    """Whether any object of the file is shaded from a map set."""
    return any(map(map_set_of, bpy.data.objects))


def objects_numbered(numbers: Collection[int]) -> list[bpy.types.Object]:
    """The objects of the file that have one of these as their `session_uid`."""
    return [each for each in bpy.data.objects if each.session_uid in numbers]


def is_hole(surface: Surface, depsgraph: bpy.types.Depsgraph) -> bool:
    """Whether a surface makes a hole in pictures: Blender's holdout, of an object or its collection."""
    # A render sets keys' values in its own copies, which are `item`
    by_layer = surface.shown_by.holdout_get(view_layer=depsgraph.view_layer)
    return bool(surface.item.is_holdout or by_layer)


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
        The object for `meshes.mesh_from_object`; valid until the next one is taken.

    Notes
    -----
    Curves, texts, metaballs and results of geometry nodes are included: Blender lists an instance of type
    mesh for each.
    """
    rendered = depsgraph.mode == "RENDER"
    for instance in depsgraph.object_instances:
        evaluated = instance.object
        bare = evaluated.display_type in UNSHADED and not rendered
        if evaluated.type != "MESH" or not instance.show_self or bare:
            continue
        item = evaluated.original
        number = item.session_uid
        shown_by = instance.parent.original if instance.is_instance else item
        if rendered:  # A render sets no key's value but in its own copies
            item = item.evaluated_get(depsgraph)
        mesh, matrix = evaluated.data.session_uid, np.array(instance.matrix_world)
        follows = follows_world(item)
        yield Surface(item, number, shown_by, mesh, matrix, map_set_of(item), follows=follows), evaluated
