"""The view of a scene's camera, as a render shows it."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import cast

import bpy
import numpy as np
from mathutils import Matrix

from ..core.conventions import Array
from ..core.errors import SceneError
from ..core.pictures.matte import PictureFrame
from .visible_surfaces import RENDER_ENGINE, Side, Surface, View, camera_frame
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
    frame : PictureFrame
        The camera's.
    """

    pose: Array
    projection: Array
    shape: tuple[int, int]
    frame: PictureFrame

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
    def number(self) -> int:
        """Always 0: a render has this view alone."""
        return 0

    @property
    def world_light(self) -> WorldLight:
        """See `View`; with the values of the frame that is rendered."""
        return world_light(self.depsgraph.scene_eval.world) or AS_IT_IS

    @property
    def picture_frame(self) -> PictureFrame:
        """See `View`: all of the frame, also where a border is rendered."""
        return self.frame

    def shows(self, surface: Surface) -> bool:
        """Whether cameras see a surface; what renders hide is not there."""
        return bool(surface.item.visible_camera)

    def has_shadow_of(self, surface: Surface) -> bool:
        """See `View`; cameras need not see it."""
        return bool(surface.item.visible_shadow)

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
    shift: float,
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
        The camera's, or an eye's of a stereoscopic picture; its scale does not count.
    shift : float
        The camera's horizontal shift, or the eye's.
    resolution : (int, int)
        Width and height of the whole frame in pixels.

    Raises
    ------
    SceneError
        See `checked_camera`, or the camera's scale is 0.
    """
    scene = depsgraph.scene
    seen_by = checked_camera(scene, camera)
    render = scene.render
    width, height = resolution
    frame = _shifted(camera_frame(seen_by, depsgraph, resolution), seen_by.data, shift)
    left, bottom, right, top = _border(render, resolution)
    part: Array = np.eye(4)
    for axis, (begin, end, size) in enumerate(((left, right, width), (bottom, top, height))):
        part[axis, axis] = size / (end - begin)
        part[axis, 3] = (size - begin - end) / (end - begin)
    unscaled: Array = np.array(pose)
    scale = np.linalg.norm(unscaled[:3, :3], axis=0)
    if not scale.all():
        raise SceneError(f"Camera {seen_by.name} is scaled to 0 and sees nothing: clear its scale.")
    unscaled[:3, :3] /= scale
    layer = scene.session_uid, depsgraph.view_layer.name
    shape, no_viewport = (right - left, top - bottom), cast(bpy.types.SpaceView3D, None)
    projection = part @ frame.projection
    return CameraView(scene, layer, depsgraph, no_viewport, unscaled, projection, shape, frame)


def _shifted(frame: PictureFrame, lens: bpy.types.Camera, shift: float) -> PictureFrame:
    """The frame of a camera with another horizontal shift."""
    # A shift is a share of the sensor or the orthographic scale, of which the frame may show a part
    across: Array = frame.projection[0, 0]
    if lens.type == "ORTHO":
        across = across * lens.ortho_scale / 2.0
    else:
        sensor = lens.sensor_height if lens.sensor_fit == "VERTICAL" else lens.sensor_width
        across = across * sensor / (2.0 * lens.lens)
    moved: Array = np.eye(4)
    moved[0, 3] = 2.0 * across * (lens.shift_x - shift)
    return replace(frame, projection=moved @ frame.projection)


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


def left_out(scene: bpy.types.Scene, layer: bpy.types.ViewLayer, camera: bpy.types.Object) -> list[str]:
    """What a scene asks for that RSIBR does not render, in sentences."""
    asked = {
        "motion blur": scene.render.use_motion_blur,
        "depth of field": camera.data.dof.use_dof,
        f"the material override of view layer {layer.name}": layer.material_override,
        f"the world override of view layer {layer.name}": layer.world_override,
    }
    told = [without(name) for name, on in asked.items() if on]
    lamps = [each.name for each in scene.objects if each.type == "LIGHT" and not each.hide_render]
    if lamps:
        of_them = f"lamp {lamps[0]}" if len(lamps) == 1 else f"{len(lamps)} lamps"
        told.append(
            f"RSIBR renders the light of the world, without that of {of_them}: "
            "Capture from Scene makes a picture of lamps for the world."
        )
    return told


def scenes_of_ours(scene: bpy.types.Scene) -> list[bpy.types.Scene]:
    """The scenes that RSIBR renders for a render of one: it, and those of its compositor and sequencer."""
    found, left = [], [scene]
    while left:
        each = left.pop()
        if each not in found:
            found.append(each)
            left += [*_composited(each), *_in_sequence(each)]
    return [each for each in found if each.render.engine == RENDER_ENGINE]


def _composited(scene: bpy.types.Scene) -> Iterator[bpy.types.Scene]:
    trees, seen = [scene.compositing_node_group if scene.render.use_compositing else None], set()
    while trees:
        tree = trees.pop()
        if tree is None or tree in seen:
            continue
        seen.add(tree)
        for node in tree.nodes:
            if node.type == "R_LAYERS" and node.scene and not node.mute:
                yield node.scene
            trees.append(getattr(node, "node_tree", None))


def _in_sequence(scene: bpy.types.Scene) -> Iterator[bpy.types.Scene]:
    editor = scene.sequence_editor if scene.render.use_sequencer else None
    strips = editor.strips_all if editor else ()
    yield from (strip.scene for strip in strips if strip.type == "SCENE" and strip.scene and not strip.mute)


def without(name: str) -> str:
    """Says that RSIBR leaves something out."""
    return f"RSIBR renders without {name}, which the scene asks for."


def _border(render: bpy.types.RenderSettings, resolution: tuple[int, int]) -> tuple[int, int, int, int]:
    """Left, bottom, right and top of what is rendered, in pixels, rounded as Blender does."""
    width, height = resolution
    if not render.use_border:
        return 0, 0, width, height
    left, right = (int(np.float32(end) * width) for end in (render.border_min_x, render.border_max_x))
    bottom, top = (int(np.float32(end) * height) for end in (render.border_min_y, render.border_max_y))
    return left, bottom, right, top
