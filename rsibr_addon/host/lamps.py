"""Lamps as seen from a point, and their light that arrives there."""

from collections.abc import Sequence
from dataclasses import dataclass

import bpy
import numpy as np
from mathutils import Matrix

from ..core.conventions import Array, ArrayLike, texel_centres
from ..core.geometry.camera import Camera
from ..core.geometry.directions import normalize
from ..core.light.lamps import angular_width, directions_in_cap
from .camera_ray_shell import show_to_camera_only
from .cameras import add_camera, closeness
from .rendering import configure_cycles, render_passes
from .spheres import add_ball
from .surroundings import TWIN_OF, Surroundings, stand_in
from .working_space import rec709_from_working

PARTS = 1024
"""Parts of a lamp with an extent: enough for one of a few texels."""

PROBE_SIZE, PROBE_SAMPLES = 64, 64
"""Pixels across the probe, and samples of each: 2e5 in all, shared among the lamps by their light."""


@dataclass(frozen=True)
class Lamp:
    """A lamp as seen from a point.

    Attributes
    ----------
    item : bpy.types.Object
        In the scene of the surroundings.
    name : str
        Full name of the artist's lamp.
    directions : ndarray, shape (count, 3)
        Unit directions to equal parts of the lamp.
    """

    item: bpy.types.Object
    name: str
    directions: Array

    @property
    def width(self) -> float:
        """Angular width [rad]."""
        return angular_width(self.directions)


def lamps_around(scene: bpy.types.Scene, point: ArrayLike) -> list[Lamp]:
    """The lamps of a scene, except those that must be left to rays.

    Parameters
    ----------
    scene : bpy.types.Scene
        As `surroundings_scene` yields it; instances of lamps become objects of it.
    point : array_like, shape (3,)

    Returns
    -------
    list of Lamp
        Without portals, which give no light, and without instances that have a size, which cannot be hidden
        from rays.
    """
    centre = np.asarray(point, dtype=np.float64)
    # Read to the end before anything is added, which changes the list.
    seen = [
        (found.object.original, found.is_instance, pose, _directions(found.object.data, pose, centre))
        for found in scene.view_layers[0].depsgraph.object_instances
        if found.object.type == "LIGHT" and _can_be_hidden(found)
        for pose in [np.array(found.matrix_world)]
    ]
    return [
        Lamp(
            _made_real(scene, item, pose) if is_instance else item,
            item.get(TWIN_OF, item.name_full),
            directions,
        )
        for item, is_instance, pose, directions in seen
    ]


def measure_lamps(scene: bpy.types.Scene, around: Surroundings, lamps: Sequence[Lamp]) -> Array:
    """Measure the light that arrives from each of several small lamps.

    Parameters
    ----------
    scene : bpy.types.Scene
        As `surroundings_scene` yields it; its render settings are replaced.
    around : Surroundings
    lamps : sequence of Lamp
        Lamps of that scene.

    Returns
    -------
    ndarray, shape (len(lamps), 3)
        Irradiance on a surface that faces the lamp, in Rec. 709; 0 where something hides the lamp.

    Raises
    ------
    RenderError

    Notes
    -----
    Energy over distance squared [Miller1984], but with all that Cycles supports: cones, node trees,
    photometric profiles and transparent shadows. A tiny white ball without a shadow both reflects and
    transmits diffusely: where its normal is n it shows E |n.w| / pi of a lamp in direction w, on either side.
    E is fitted to all its pixels; light groups tell the lamps apart.
    """
    layer = scene.view_layers[0]
    for index, lamp in enumerate(lamps):
        lamp.item.lightgroup = layer.lightgroups.add(name=f"lamp{index}").name
    normals, inside = _add_probe(scene, around)
    configure_cycles(scene, PROBE_SIZE, PROBE_SIZE, PROBE_SAMPLES)
    passes = render_passes(scene)
    irradiance = np.zeros((len(lamps), 3))
    for index, lamp in enumerate(lamps):
        cosine = np.abs(normals @ normalize(lamp.directions.sum(axis=0)))
        shown = passes[f"Combined_lamp{index}"][inside]
        irradiance[index] = np.pi * (cosine @ shown) / (cosine @ cosine)
    return rec709_from_working(irradiance)


def _add_probe(scene: bpy.types.Scene, around: Surroundings) -> tuple[Array, Array]:
    """A ball and its camera; normals (count, 3) of the pixels inside, and which pixels these are."""
    radius, camera = closeness(around.point), Camera((0.0, 0.0, 1.0))
    ball = add_ball(scene, radius, _white(), around.point)
    show_to_camera_only(ball)
    stand_in(scene, around, ball)
    item = add_camera(scene, camera)
    item.location = np.asarray(around.point) + radius * camera.world_from_camera[:3, 3]
    item.data.ortho_scale, item.data.clip_start, item.data.clip_end = 2.0 * radius, 0.5 * radius, 2.0 * radius
    xy = 2.0 * texel_centres(PROBE_SIZE, PROBE_SIZE) - 1.0
    inside = np.linalg.norm(xy, axis=-1) < 1.0 - 2.0 / PROBE_SIZE
    z = np.sqrt(1.0 - np.sum(xy[inside] ** 2, axis=-1, keepdims=True))
    return np.concatenate([xy[inside], z], axis=-1) @ camera.frame.T, inside


def _white() -> bpy.types.Material:
    """A material that shows the light of both its sides."""
    material = bpy.data.materials.new("RSIBR white")
    tree = material.node_tree
    tree.nodes.clear()
    both = tree.nodes.new("ShaderNodeAddShader")
    for socket, kind in zip(both.inputs, ("ShaderNodeBsdfDiffuse", "ShaderNodeBsdfTranslucent"), strict=True):
        half = tree.nodes.new(kind)
        half.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
        tree.links.new(half.outputs[0], socket)
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(both.outputs[0], output.inputs["Surface"])
    return material


def _can_be_hidden(found: bpy.types.DepsgraphObjectInstance) -> bool:
    """Whether a lamp can be hidden from rays: a twin, or an instance that no ray finds anyway."""
    return not _has_size(found.object.data) if found.is_instance else TWIN_OF in found.object


def _made_real(scene: bpy.types.Scene, item: bpy.types.Object, pose: Array) -> bpy.types.Object:
    real = bpy.data.objects.new("RSIBR lamp", item.data)
    real.matrix_world = Matrix(pose)
    real.visible_diffuse = item.visible_diffuse
    scene.collection.objects.link(real)
    return real


def _has_size(data: bpy.types.Light) -> bool:
    match data.type:
        case "AREA":
            return True
        case "SUN":
            return bool(data.angle > 0.0)
        case _:
            return bool(data.shadow_soft_size > 0.0)


def _directions(data: bpy.types.Light, pose: Array, point: Array) -> Array:
    """Unit directions to equal parts of a lamp, shape (count, 3); all around if the point is in it."""
    count = PARTS if _has_size(data) else 1
    if data.type == "SUN":
        return directions_in_cap(normalize(pose[:3, 2]), 0.5 * data.angle, count)
    towards = pose[:3, 3] - point
    distance = np.linalg.norm(towards)
    if data.type == "AREA":
        parts = _points(data) @ pose[:3, :3].T + towards
        return parts / np.maximum(np.linalg.norm(parts, axis=-1, keepdims=True), closeness(point))
    if distance <= closeness(point):
        return directions_in_cap((0.0, 0.0, 1.0), np.pi, PARTS)
    # Cycles shows the disk that faces the point; without "Soft Falloff" a ball, which looks hardly larger.
    # Neither grows with the object's scale.
    return directions_in_cap(towards / distance, np.arctan(data.shadow_soft_size / distance), count)


def _points(data: bpy.types.Light) -> Array:
    """Points spread over an area lamp, shape (count, 3), in its own coordinates."""
    side = int(np.sqrt(PARTS))
    unit = texel_centres(side, side).reshape(-1, 2) - 0.5
    if data.shape in ("DISK", "ELLIPSE"):
        unit = unit[np.linalg.norm(unit, axis=-1) <= 0.5]
    height = data.size_y if data.shape in ("RECTANGLE", "ELLIPSE") else data.size
    return np.concatenate([unit * (data.size, height), np.zeros((len(unit), 1))], axis=-1)
