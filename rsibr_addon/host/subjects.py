"""Objects that are lit: their parts, and their centres."""

import bpy
import numpy as np

from ..core.conventions import Array
from ..core.counted import in_short
from ..core.errors import SceneError
from ..core.near_names import did_you_mean

SOLID = {"MESH", "CURVE", "SURFACE", "META", "FONT", "CURVES", "POINTCLOUD", "VOLUME", "GREASEPENCIL"}
"""Types of objects with an extent."""


def find_object(scene: bpy.types.Scene, name: str) -> bpy.types.Object:
    """The object of that name in a scene.

    Raises
    ------
    SceneError
        There is none.
    """
    found: bpy.types.Object | None = scene.objects.get(name)
    if found is None:
        names = [item.name for item in scene.objects]
        shown = in_short(names) or "another scene, as it is empty"
        near = did_you_mean(name, names)
        raise SceneError(f"Scene {scene.name} holds no object {name}{near}: choose one of {shown}.")
    return found


def parts_of(subject: bpy.types.Object) -> set[bpy.types.Object]:
    """An object, and all objects that are parented to it, directly or not, except lamps.

    Returns
    -------
    set of bpy.types.Object
        Without instances, which go with the object that makes them.
    """
    return {subject, *(child for child in subject.children_recursive if child.type != "LIGHT")}


def centre_of(layer: bpy.types.ViewLayer, subject: bpy.types.Object) -> Array:
    """The middle of an object and its parts.

    Parameters
    ----------
    layer : bpy.types.ViewLayer
        View layer of a scene that is evaluated at the frame in question.
    subject : bpy.types.Object

    Returns
    -------
    ndarray, shape (3,)
        Centre, in world coordinates, of the box along the world's axes that contains their boxes, with all
        modifiers and instances; the object's origin where nothing has an extent.
    """
    depsgraph = layer.depsgraph
    parts = parts_of(subject)
    corners = [
        np.asarray(instance.matrix_world) @ (*corner, 1.0)
        for instance in depsgraph.object_instances
        if (instance.parent if instance.is_instance else instance.object).original in parts
        and instance.object.type in SOLID
        for corner in instance.object.bound_box
    ]
    if not corners:
        return np.array(subject.evaluated_get(depsgraph).matrix_world.translation)
    return 0.5 * (np.min(corners, axis=0) + np.max(corners, axis=0))[:3]
