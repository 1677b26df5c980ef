"""A shell that makes a camera see as a surface does: its rays go on as other rays."""

import bpy

from ..core.conventions import ArrayLike

RAYS = ("diffuse", "glossy", "transmission", "volume_scatter", "shadow")
"""Kinds of rays except the camera's, by their names in Blender."""


def add_camera_ray_shell(
    scene: bpy.types.Scene, point: ArrayLike = (0.0, 0.0, 0.0), half_width: float = 1.0
) -> bpy.types.Object:
    """Put a cube about a camera through which its rays go straight, but no longer as camera rays.

    Parameters
    ----------
    scene : bpy.types.Scene
        To be rendered by Cycles with one more bounce, of transmission, than without the shell.
    point : array_like, shape (3,)
        The cube's middle, in world coordinates.
    half_width : float
        Half the cube's width.

    Notes
    -----
    Beyond it, Cycles shows what it hides from camera rays: above all lamps, and what a world's nodes have for
    other rays. Only camera rays meet the shell.
    """
    material = bpy.data.materials.new("RSIBR shell")
    tree = material.node_tree
    tree.nodes.clear()
    refraction = tree.nodes.new("ShaderNodeBsdfRefraction")
    refraction.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    refraction.inputs["Roughness"].default_value = 0.0
    refraction.inputs["IOR"].default_value = 1.0
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(refraction.outputs["BSDF"], output.inputs["Surface"])
    corners = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    data = bpy.data.meshes.new("RSIBR shell")
    data.from_pydata(corners, [], faces)
    data.materials.append(material)
    shell = bpy.data.objects.new("RSIBR shell", data)
    shell.location, shell.scale = point, (half_width,) * 3
    show_to_camera_only(shell)
    scene.collection.objects.link(shell)
    return shell


def show_to_camera_only(item: bpy.types.Object) -> None:
    """Hide an object of our own from all rays but the camera's."""
    for rays in RAYS:
        setattr(item, f"visible_{rays}", False)
