"""Our cameras as objects of Blender."""

import bpy
import numpy as np
from mathutils import Matrix

from ..core.conventions import Array, ArrayLike
from ..core.geometry.camera import Camera
from ..core.maps.cube_map import FACES

CLOSE = 1e-4
"""Size of things about a camera that must not meet anything, relative to their surroundings."""


def add_camera(scene: bpy.types.Scene, camera: Camera) -> bpy.types.Object:
    """Add a camera that looks at a scene.

    Parameters
    ----------
    scene : bpy.types.Scene
        Its active camera becomes the new one.
    camera : Camera
        Its frame is square: see `core.geometry.camera`; the scene's resolution should be square.
    """
    data = bpy.data.cameras.new("RSIBR camera")
    if camera.field_of_view is None:
        data.type, data.ortho_scale = "ORTHO", 2.0
    else:
        data.type, data.angle = "PERSP", camera.field_of_view
    data.clip_start, data.clip_end = 1e-3, 2.0 * camera.distance
    return _add(scene, data, camera.world_from_camera)


def add_panoramic_camera(scene: bpy.types.Scene, point: ArrayLike = (0.0, 0.0, 0.0)) -> bpy.types.Object:
    """Add a camera within a scene that looks all around.

    Parameters
    ----------
    scene : bpy.types.Scene
        The camera becomes its active one; at any resolution, the picture shows all directions.
    point : array_like, shape (3,)
        The camera's place, in world coordinates.

    Returns
    -------
    bpy.types.Object
        Its pictures are equirectangular: the middle shows +X, the top +Z.
    """
    data = bpy.data.cameras.new("RSIBR panorama")
    data.type, data.panorama_type = "PANO", "EQUIRECTANGULAR"
    return _add_within(scene, data, ((0.0, 0.0, -1.0), (-1.0, 0.0, 0.0), (0.0, 1.0, 0.0)), point)


def add_face_camera(scene: bpy.types.Scene, face: int, point: ArrayLike) -> bpy.types.Object:
    """Add a camera within a scene that looks through one face of a cube.

    Parameters
    ----------
    scene : bpy.types.Scene
        Its active camera becomes the new one; its resolution should be square.
    face : int
        In the order of `core.maps.cube_map`, 0 to 5.
    point : array_like, shape (3,)
        The cube's centre, in world coordinates.

    Returns
    -------
    bpy.types.Object
        Its pictures show that face, in the world's axes: row 0 is OpenGL's first.
    """
    data = bpy.data.cameras.new("RSIBR face")
    data.type, data.angle = "PERSP", np.pi / 2.0
    right, up, ahead = FACES[face]
    return _add_within(scene, data, np.stack([right, up, -ahead], axis=1), point)


def closeness(point: ArrayLike) -> float:
    """A length that is short for a scene, but not for float32 coordinates about a point.

    Parameters
    ----------
    point : array_like, shape (3,)
        In world coordinates.

    Returns
    -------
    float
        `CLOSE` of a metre and of the distance from the origin.
    """
    return CLOSE * (1.0 + float(np.linalg.norm(point)))


def _add_within(
    scene: bpy.types.Scene, data: bpy.types.Camera, frame: ArrayLike, point: ArrayLike
) -> bpy.types.Object:
    data.clip_start = 0.1 * closeness(point)
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = frame, point
    return _add(scene, data, pose)


def _add(scene: bpy.types.Scene, data: bpy.types.Camera, pose: Array) -> bpy.types.Object:
    item = bpy.data.objects.new(data.name, data)
    item.matrix_world = Matrix(pose)
    scene.collection.objects.link(item)
    scene.camera = item
    return item
