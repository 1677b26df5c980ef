"""A scene's lamps that are suns, as a viewport has them."""

import bpy
import numpy as np
from mathutils import Vector

from ..core.conventions import Array
from ..core.geometry.directions import normalize


def suns_above(
    scene: bpy.types.Scene,
    depsgraph: bpy.types.Depsgraph,
    shading: bpy.types.View3DShading,
    point: Array,
    distance: float,
) -> tuple[Array, Array, float]:
    """The suns that light a point of a viewport.

    Parameters
    ----------
    scene : bpy.types.Scene
    depsgraph : bpy.types.Depsgraph
        Evaluated.
    shading : bpy.types.View3DShading
        Of the viewport, which may leave lamps out.
    point : ndarray, shape (3,)
    distance : float
        What is nearer to the point hides no sun; what is further hides it wholly.

    Returns
    -------
    direction : ndarray, shape (N, 3)
        Unit vectors towards them.
    irradiance : ndarray, shape (N, 3)
        On a surface that faces them; what a lamp's nodes say is left out.
    angle : float
        Angle across the smallest [rad]; pi where there is none.
    """
    shown = {"MATERIAL": shading.use_scene_lights, "RENDERED": shading.use_scene_lights_render}
    directions, irradiances, angles = [], [], [np.pi]
    for instance in depsgraph.object_instances if shown.get(shading.type, False) else ():
        if instance.object.type != "LIGHT" or instance.object.data.type != "SUN":
            continue
        towards = normalize(np.array(instance.matrix_world)[:3, 2])
        irradiance = _irradiance(instance.object.data)
        begin = Vector((point + distance * towards).tolist())
        is_hidden, *_ = scene.ray_cast(depsgraph, begin, Vector(towards.tolist()))
        if irradiance.any() and not is_hidden:
            directions.append(towards)
            irradiances.append(irradiance)
            angles.append(instance.object.data.angle)
    return np.reshape(directions, (-1, 3)), np.reshape(irradiances, (-1, 3)), min(angles)


def _irradiance(lamp: bpy.types.Light) -> Array:
    """On a surface that faces the lamp, shape (3,)."""
    colour = np.array(lamp.color)
    if lamp.use_temperature:
        colour = colour * np.array(lamp.temperature_color)
    irradiance: Array = np.maximum(colour * lamp.energy * 2.0**lamp.exposure, 0.0)
    return irradiance
