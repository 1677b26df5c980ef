"""Spheres, such as the one on which materials are captured."""

import bpy

from ..core.conventions import ArrayLike

CORE_RADIUS = 0.99999
"""Radius of the black core: too close beneath the surface to show at its rim."""


def add_sphere(scene: bpy.types.Scene, material: bpy.types.Material) -> bpy.types.Object:
    """Put the unit sphere about the origin into a scene.

    Parameters
    ----------
    scene : bpy.types.Scene
        To be rendered by Cycles.
    material : bpy.types.Material

    Notes
    -----
    A point cloud of one point, which Cycles intersects as a sphere: its normals are exact. A black core that
    only the camera sees closes a transparent material from behind, so that coverage is the sphere's own.
    Refracted light leaves without meeting the sphere again.
    """
    core = add_ball(scene, CORE_RADIUS, _black())
    core.visible_diffuse = core.visible_glossy = core.visible_transmission = False
    core.visible_volume_scatter = core.visible_shadow = False
    return add_ball(scene, 1.0, material)


def add_ball(
    scene: bpy.types.Scene,
    radius: float,
    material: bpy.types.Material,
    point: ArrayLike = (0.0, 0.0, 0.0),
) -> bpy.types.Object:
    """Put a sphere into a scene that Cycles intersects exactly.

    Parameters
    ----------
    scene : bpy.types.Scene
    radius : float
    material : bpy.types.Material
    point : array_like, shape (3,)
        The sphere's centre.
    """
    cloud = bpy.data.pointclouds.new("RSIBR sphere")
    cloud.resize(1)
    cloud.points[0].co = (0.0, 0.0, 0.0)
    cloud.points[0].radius = radius
    cloud.materials.append(material)
    item = bpy.data.objects.new("RSIBR sphere", cloud)
    item.location = point
    scene.collection.objects.link(item)
    return item


def _black() -> bpy.types.Material:
    material = bpy.data.materials.new("RSIBR black")
    nodes = material.node_tree.nodes
    nodes.clear()
    nothing = nodes.new("ShaderNodeEmission")
    nothing.inputs["Strength"].default_value = 0.0
    output = nodes.new("ShaderNodeOutputMaterial")
    material.node_tree.links.new(nothing.outputs[0], output.inputs["Surface"])
    return material
