"""Our camera as Blender's."""

import bpy
from mathutils import Matrix

from ..core.camera import Camera


def add_camera(scene: bpy.types.Scene, camera: Camera) -> bpy.types.Object:
    """Look at a scene through a camera.

    Parameters
    ----------
    scene : bpy.types.Scene
        Its active camera becomes the new one.
    camera : Camera
        Fills square frames as `core.camera` says; the scene's resolution should be square.

    Returns
    -------
    bpy.types.Object
    """
    data = bpy.data.cameras.new("RSIBR camera")
    if camera.field_of_view is None:
        data.type, data.ortho_scale = "ORTHO", 2.0
    else:
        data.type, data.angle = "PERSP", camera.field_of_view
    data.clip_start, data.clip_end = 1e-3, 2.0 * camera.distance
    item = bpy.data.objects.new("RSIBR camera", data)
    item.matrix_world = Matrix(camera.world_from_camera)
    scene.collection.objects.link(item)
    scene.camera = item
    return item
