"""The view of a scene's camera, as a render shows it."""

from dataclasses import dataclass, replace
from typing import cast

import bpy
import numpy as np
from mathutils import Matrix

from ..core.conventions import Array
from ..core.errors import SceneError
from .visible_surfaces import Side, Surface, View
from .world_light import AS_IT_IS, WorldLight, world_light

CAMERAS = ("PERSP", "ORTHO")
"""Types of cameras whose rays a matrix describes."""

NOTHING = 1e10
"""Depth of what no surface covers, as Cycles has it."""


@dataclass(frozen=True)
class CameraView(View):
    """What a camera sees in a render.

    Attributes
    ----------
    pose : ndarray, shape (4, 4)
        World from eye coordinates.
    projection : ndarray, shape (4, 4)
        From eye coordinates to the picture's.
    shape : (int, int)
        Width and height in pixels.
    """

    pose: Array
    projection: Array
    shape: tuple[int, int]

    @property
    def shaded(self) -> bool:
        """Always."""
        return True

    @property
    def has_depth(self) -> bool:
        """Never: nothing else is drawn."""
        return False

    @property
    def shades_all(self) -> bool:
        """Always."""
        return True

    @property
    def sides(self) -> tuple[Side, ...]:
        """The first look of all objects."""
        return (Side(other=False, left=0.0, right=1.0),)

    @property
    def matrices(self) -> tuple[Array, Array]:
        """See `View`."""
        return np.linalg.inv(self.pose), self.projection

    @property
    def size(self) -> tuple[int, int]:
        """See `View`."""
        return self.shape

    @property
    def world_light(self) -> WorldLight:
        """See `View`; with the values of the frame that is rendered."""
        return world_light(self.depsgraph.scene_eval.world) or AS_IT_IS

    def shows(self, surface: Surface) -> bool:
        """Whether cameras see a surface; what renders hide is not there."""
        return bool(surface.item.visible_camera)

    def moved(self, offset: tuple[float, float]) -> "CameraView":
        """The same with all points moved, by parts of a pixel to the right and up."""
        shift: Array = np.eye(4)
        shift[:2, 3] = 2.0 * np.array(offset) / self.shape
        return replace(self, projection=shift @ self.projection)

    def distances(self, depths: Array) -> Array:
        """Distances from the camera's plane, of depths in [0, 1]; `NOTHING` where they are 1."""
        (a, b), (c, d) = self.projection[2:, 2:]
        placed = 2.0 * depths.astype(np.float64) - 1.0
        return np.where(depths < 1.0, -(placed * d - b) / (a - placed * c), NOTHING).astype(np.float32)


def camera_view(
    depsgraph: bpy.types.Depsgraph,
    camera: bpy.types.Object | None,
    pose: Matrix | None,
    resolution: tuple[int, int],
) -> CameraView:
    """The view of a camera, within the render's border if it has one.

    Parameters
    ----------
    depsgraph : bpy.types.Depsgraph
        That of the render.
    camera : bpy.types.Object or None
        Evaluated.
    pose : Matrix or None
        The camera's; its scale does not count.
    resolution : (int, int)
        Width and height of the whole frame in pixels.

    Raises
    ------
    SceneError
        See `checked_camera`.
    """
    scene = depsgraph.scene
    seen_by = checked_camera(scene, camera)
    render = scene.render
    width, height = resolution
    whole = seen_by.calc_matrix_camera(
        depsgraph, x=width, y=height, scale_x=render.pixel_aspect_x, scale_y=render.pixel_aspect_y
    )
    left, bottom, right, top = _border(render, resolution)
    part: Array = np.eye(4)
    for axis, (begin, end, size) in enumerate(((left, right, width), (bottom, top, height))):
        part[axis, axis] = size / (end - begin)
        part[axis, 3] = (size - begin - end) / (end - begin)
    unscaled: Array = np.array(pose)
    unscaled[:3, :3] /= np.linalg.norm(unscaled[:3, :3], axis=0)
    layer = scene.session_uid, depsgraph.view_layer.name
    shape, no_viewport = (right - left, top - bottom), cast(bpy.types.SpaceView3D, None)
    return CameraView(scene, layer, depsgraph, no_viewport, unscaled, part @ np.array(whole), shape)


def checked_camera(scene: bpy.types.Scene, camera: bpy.types.Object | None) -> bpy.types.Object:
    """The camera of a scene, if pictures can be rendered with it.

    Raises
    ------
    SceneError
        There is none, or it is panoramic.
    """
    if camera is None or camera.type != "CAMERA":
        raise SceneError(f"Scene {scene.name} has no camera: add one, or choose it in the Scene properties.")
    if camera.data.type not in CAMERAS:
        raise SceneError(
            f"Camera {camera.name} is panoramic, and RSIBR renders perspective and orthographic cameras: "
            f"change its type, or render with Cycles."
        )
    return camera


def left_out(scene: bpy.types.Scene, camera: bpy.types.Object) -> list[str]:
    """What a scene asks for that RSIBR does not render, in sentences."""
    asked = {
        "motion blur": scene.render.use_motion_blur,
        "depth of field": camera.data.dof.use_dof,
        "stereoscopy": scene.render.use_multiview,
    }
    told = [f"RSIBR renders without {name}, which the scene asks for." for name, on in asked.items() if on]
    lamps = [each.name for each in scene.objects if each.type == "LIGHT" and not each.hide_render]
    if lamps:
        of_them = f"lamp {lamps[0]}" if len(lamps) == 1 else f"{len(lamps)} lamps"
        told.append(
            f"RSIBR renders the light of the world, without that of {of_them}: "
            "Capture from Scene makes a picture of lamps for the world."
        )
    return told


def _border(render: bpy.types.RenderSettings, resolution: tuple[int, int]) -> tuple[int, int, int, int]:
    """Left, bottom, right and top of what is rendered, in pixels, rounded as Blender does."""
    width, height = resolution
    if not render.use_border:
        return 0, 0, width, height
    left, right = (int(np.float32(end) * width) for end in (render.border_min_x, render.border_max_x))
    bottom, top = (int(np.float32(end) * height) for end in (render.border_min_y, render.border_max_y))
    return left, bottom, right, top
