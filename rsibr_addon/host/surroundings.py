"""A scene as seen from a point within, without the object that stands there."""

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import bpy
import numpy as np

from ..core.conventions import Array
from ..core.errors import SceneError
from .camera_ray_shell import add_camera_ray_shell
from .cameras import add_face_camera, add_panoramic_camera, closeness
from .light_linking import take_place_of
from .rendering import configure_cycles, render_passes
from .scenes import find_scene, temporary_copy
from .subjects import centre_of, find_object, parts_of
from .working_space import rec709_from_working

TWIN_OF = "RSIBR twin of"
"""Property of a lamp of ours with the full name of the artist's lamp."""


@dataclass(frozen=True)
class Surroundings:
    """The surroundings of a point in a scene of the open file.

    Attributes
    ----------
    scene : str
        Its name.
    layer : str
        The view layer whose collections count.
    frame : float
    subject : str or None
        Name of the object that is left out, with its parts: see `host.subjects.parts_of`.
    point : tuple of 3 floats
        In world coordinates.
    unseen : frozenset of str
        Full names of lamps that light everything but are hidden from rays.
    """

    scene: str
    layer: str
    frame: float
    subject: str | None
    point: tuple[float, float, float]
    unseen: frozenset[str] = frozenset()


@dataclass(frozen=True)
class Sampling:
    """The samples of a picture.

    Attributes
    ----------
    start, count : int
        First sample in the sequence, and number of samples.
    total : int
        Number of samples of all pictures that will be averaged.
    seed : int
        Seed of the sequence.
    guides : bool
        Whether the picture comes with a denoiser's guides.
    """

    start: int
    count: int
    total: int
    seed: int
    guides: bool = False


def surroundings_of(
    scene: str | None, subject: str | None, point: tuple[float, float, float] | None, frame: int | None
) -> Surroundings:
    """The surroundings of an object, or of a point.

    Parameters
    ----------
    scene : str or None
        Its name; None for the one that the artist works in.
    subject : str or None
        Name of the object that is left out, if any.
    point : tuple of 3 floats, or None
        None for the middle of the object, or without one for the 3D cursor.
    frame : int or None
        None for the scene's current one.

    Raises
    ------
    SceneError
        There is no such scene or object, or it has no surroundings.
    """
    source = find_scene(scene)
    layer = bpy.context.view_layer if source == bpy.context.scene else source.view_layers[0]
    when = source.frame_current_final if frame is None else float(frame)
    hidden = parts_of(find_object(source, subject)) if subject else set()
    if source.world is None and not set(_rendered(layer.layer_collection)) - hidden:
        raise SceneError(
            f"There is nothing to see in scene {source.name}: add a world, or lamps and objects."
        )
    if point is not None:
        middle = np.array(point)
    elif subject:
        middle = _centre_at(source, layer, find_object(source, subject), when)
    else:
        middle = np.array(source.cursor.location)
    return Surroundings(source.name, layer.name, when, subject, tuple(middle.tolist()))


@contextmanager
def surroundings_scene(around: Surroundings) -> Iterator[bpy.types.Scene]:
    """Work in a scene of the surroundings; afterwards the file is as it was.

    Yields
    ------
    bpy.types.Scene
        At its frame, evaluated; all rendered objects of the view layer in one collection and one view
        layer. Lamps are twins of the artist's, which `TWIN_OF` names.

    Raises
    ------
    SceneError
        The scene, the view layer or the object is missing.

    Notes
    -----
    Collections and view layers may hold objects out, or show them in reflections only; light ignores this. It
    also ignores settings for pictures, such as borders, compositing or exposure.
    """
    source = find_scene(around.scene)
    layer = source.view_layers.get(around.layer)
    if layer is None:
        raise SceneError(f"Scene {source.name} has no view layer {around.layer}: it was removed meanwhile.")
    hidden = parts_of(find_object(source, around.subject)) if around.subject else set()
    # In their order, each once
    shown = [item for item in dict.fromkeys(_rendered(layer.layer_collection)) if item not in hidden]
    with _copy_to_evaluate(source) as scene:
        _replace_contents(scene, layer)
        for item in shown:
            scene.collection.objects.link(_twin(item, around.unseen) if _is_lamp(item) else item)
        _take_light_as_it_is(scene)
        _go_to(scene, around.frame)
        yield scene


def render_surroundings(
    scene: bpy.types.Scene,
    around: Surroundings,
    face: int | None,
    size: tuple[int, int],
    sampling: Sampling,
) -> dict[str, Array]:
    """Render the light that arrives at a point.

    Parameters
    ----------
    scene : bpy.types.Scene
        As `surroundings_scene` yields it.
    around : Surroundings
    face : int or None
        Face of a cube: see `add_face_camera`; None for a panorama: see `add_panoramic_camera`.
    size : tuple of 2 int
        Width and height of the picture in pixels.
    sampling : Sampling

    Returns
    -------
    dict of str to ndarray, shape (height, width, 3), float32
        "radiance", in Rec. 709; with guides also "albedo" and "normal".

    Raises
    ------
    RenderError

    Notes
    -----
    The render has one bounce more than the scene, because the shell about the camera takes one: lamps show
    through it, and the picture is the light on a surface, not the camera's view.
    """
    bounces = scene.cycles.max_bounces, scene.cycles.transmission_bounces
    configure_cycles(scene, *size, sampling.total)
    cycles = scene.cycles
    cycles.max_bounces, cycles.transmission_bounces = (count + 1 for count in bounces)
    cycles.seed, cycles.use_sample_subset = sampling.seed, True
    cycles.sample_offset, cycles.sample_subset_length = sampling.start, sampling.count
    scene.view_layers[0].cycles.denoising_store_passes = sampling.guides
    if face is None:
        add_panoramic_camera(scene, around.point)
    else:
        add_face_camera(scene, face, around.point)
    stand_in(scene, around, add_camera_ray_shell(scene, around.point, closeness(around.point)))
    passes = render_passes(scene)
    seen = {"radiance": rec709_from_working(passes["Combined"][..., :3])}
    if sampling.guides:
        seen |= {"albedo": passes["Denoising Albedo"], "normal": passes["Denoising Normal"]}
    return seen


def stand_in(scene: bpy.types.Scene, around: Surroundings, item: bpy.types.Object) -> None:
    """Make the lamps of a scene of surroundings light an object of ours as they light the subject, if any."""
    if around.subject:
        subject = find_object(find_scene(around.scene), around.subject)
        take_place_of(subject, item, [lamp for lamp in scene.objects if TWIN_OF in lamp])


@contextmanager
def _copy_to_evaluate(scene: bpy.types.Scene) -> Iterator[bpy.types.Scene]:
    """A temporary copy; afterwards Blender computes particles anew, as both scenes' share one memory.

    Now and then Blender leaves none alive otherwise, until the next frame.
    """
    try:
        with temporary_copy(scene) as copy:
            yield copy
    finally:
        for item in scene.objects:
            if item.particle_systems:
                item.update_tag()


def _centre_at(
    scene: bpy.types.Scene, layer: bpy.types.ViewLayer, subject: bpy.types.Object, frame: float
) -> Array:
    if frame == scene.frame_current_final:
        layer.update()
        return centre_of(layer, subject)
    with _copy_to_evaluate(scene) as scene_at_frame:
        _go_to(scene_at_frame, frame)
        return centre_of(scene_at_frame.view_layers[layer.name], subject)


def _go_to(scene: bpy.types.Scene, frame: float) -> None:
    whole = math.floor(frame)
    scene.frame_set(whole, subframe=frame - whole)


def _rendered(layer: bpy.types.LayerCollection) -> Iterator[bpy.types.Object]:
    """Objects in collections that are rendered; their own settings are left to Blender."""
    if layer.collection.hide_render:
        return
    if not layer.exclude:
        yield from layer.collection.objects
    for child in layer.children:
        yield from _rendered(child)


def _replace_contents(scene: bpy.types.Scene, layer: bpy.types.ViewLayer) -> None:
    """Empty a copied scene, and give it a plain view layer in place of all."""
    for collection in list(scene.collection.children):
        scene.collection.children.unlink(collection)
    for item in list(scene.collection.objects):
        scene.collection.objects.unlink(item)
    plain = scene.view_layers.new("RSIBR")
    plain.material_override, plain.world_override = layer.material_override, layer.world_override
    for other in list(scene.view_layers):
        if other != plain:
            scene.view_layers.remove(other)


def _is_lamp(item: bpy.types.Object) -> bool:
    """Whether an object gives light; a portal only helps Cycles to find the world's light."""
    return item.type == "LIGHT" and not (item.data.type == "AREA" and item.data.cycles.is_portal)


def _twin(lamp: bpy.types.Object, unseen: frozenset[str]) -> bpy.types.Object:
    """A lamp that shows itself to all rays from surfaces, or to none."""
    twin = lamp.copy()
    twin.data = lamp.data.copy()
    twin[TWIN_OF] = lamp.name_full
    if lamp.light_linking.receiver_collection:
        twin.light_linking.receiver_collection = lamp.light_linking.receiver_collection.copy()
    twin.data.cycles.use_multiple_importance_sampling = True
    twin.visible_transmission = lamp.visible_diffuse and lamp.name_full not in unseen
    return twin


def _take_light_as_it_is(scene: bpy.types.Scene) -> None:
    render, cycles = scene.render, scene.cycles
    render.use_compositing = render.use_sequencer = render.use_multiview = render.use_freestyle = False
    render.use_border = render.use_motion_blur = render.film_transparent = render.use_stamp = False
    render.use_persistent_data = False
    render.pixel_aspect_x = render.pixel_aspect_y = 1.0
    cycles.film_exposure = 1.0
    cycles.use_animated_seed = cycles.use_sample_subset = False
    cycles.time_limit = 0.0
    # To a camera behind the shell, a surface's direct light is indirect light.
    cycles.sample_clamp_indirect = 0.0
    cycles.use_light_tree = True
