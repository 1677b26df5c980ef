"""The display of a scene's radiance: its view transform, look, exposure, gamma and curves."""

from dataclasses import dataclass

import bpy
import numpy as np

from ..core.conventions import Array
from ..files.photographs import read_photograph
from ..files.temporary import temporary_folder
from .scenes import temporary_copy
from .working_space import working_from_rec709

WIDTH = 1024
"""Width of the picture through which colours are sent, in pixels."""

Display = tuple[object, ...]
"""All settings that determine the display of radiance, the device first; equal for scenes that show it
equally."""


def display_of(scene: bpy.types.Scene) -> Display:
    """All settings on which `displayed_colours` depends.

    Returns
    -------
    Display
        For comparison. It does not include exposure, but see `baked_exposure`.
    """
    view = scene.view_settings
    balance = (view.white_balance_temperature, view.white_balance_tint) if view.use_white_balance else ()
    return (
        scene.display_settings.display_device,
        view.view_transform,
        view.look,
        view.gamma,
        balance,
        baked_exposure(scene),
        _curves(view.curve_mapping) if view.use_curve_mapping else (),
    )


def baked_exposure(scene: bpy.types.Scene) -> float:
    """The stops of exposure that `displayed_colours` contains.

    All other stops double radiance before it is shown, which a shader does at once while the artist moves the
    slider. With curves, exposure comes after them and has to be contained.
    """
    view = scene.view_settings
    return float(view.exposure) if view.use_curve_mapping else 0.0


def scale_before_display(scene: bpy.types.Scene) -> float:
    """The factor of radiance before its lookup in `displayed_colours`."""
    return float(2.0 ** (scene.view_settings.exposure - baked_exposure(scene)))


@dataclass(frozen=True)
class SurfaceDisplay:
    """What Blender does to a viewport's surfaces before it lays overlays over them.

    Attributes
    ----------
    transforms : bool
        Whether it applies the scene's view transform. Otherwise it only encodes colours as sRGB.
    scale : float
        The factor of radiance that its transform lacks.
    """

    transforms: bool
    scale: float = 1.0


def surface_display(
    scene: bpy.types.Scene, space: bpy.types.SpaceView3D, display: Display
) -> SurfaceDisplay | None:
    """How the colours of a viewport's surfaces come to the display, in a file that works in Rec. 709.

    Parameters
    ----------
    scene : bpy.types.Scene
    space : bpy.types.SpaceView3D
    display : Display
        The scene's.

    Returns
    -------
    SurfaceDisplay or None
        None where radiance or colours of ours would not be shown as the scene's settings show them, or where
        Blender may leave a surface out: then its background covers them.
    """
    shading, view = space.shading, scene.view_settings
    match shading.type:
        case "SOLID":
            is_encoded = display[0] == "sRGB" and not shading.show_xray
            return SurfaceDisplay(transforms=False) if is_encoded else None
        case "MATERIAL":
            lit = shading.use_scene_lights or shading.use_scene_world
        case _:
            lit = shading.use_scene_lights_render or shading.use_scene_world_render
            if not scene.render.engine.startswith("BLENDER_EEVEE"):
                return None
    if lit:
        return SurfaceDisplay(transforms=True)
    # Of the scene's settings, Blender uses the view transform and the look alone
    if view.gamma != 1.0 or view.use_curve_mapping or view.use_white_balance:
        return None
    return SurfaceDisplay(transforms=True, scale=scale_before_display(scene))


def displayed_colours(scene: bpy.types.Scene, radiance: Array) -> Array:
    """The displayed colours of radiance in a scene.

    Parameters
    ----------
    scene : bpy.types.Scene
    radiance : ndarray, shape (..., 3)
        Scene-linear Rec. 709.

    Returns
    -------
    ndarray, shape (..., 3), float32
        In [0, 1], as sent to the scene's display device; exact to 16 bits.

    Notes
    -----
    Blender's module has no interface to its colour management, but applies the scene's to a picture that is
    saved as a render.
    """
    colours = radiance.reshape(-1, 3)
    height = -(-len(colours) // WIDTH)
    pixels: Array = np.ones((height * WIDTH, 4), dtype=np.float32)
    pixels[: len(colours), :3] = working_from_rec709(colours)
    with temporary_folder() as folder, temporary_copy(scene) as copy:
        path = folder / "displayed.png"
        copy.view_settings.exposure = baked_exposure(scene)
        copy.render.dither_intensity = 0.0
        settings = copy.render.image_settings
        settings.media_type = "IMAGE"
        settings.file_format, settings.color_mode, settings.color_depth = "PNG", "RGB", "16"
        settings.color_management = "FOLLOW_SCENE"
        settings.compression = 0
        image = bpy.data.images.new("displayed", WIDTH, height, float_buffer=True)
        image.pixels.foreach_set(pixels.ravel())
        image.save_render(str(path), scene=copy)
        shown = read_photograph(path).encoded()
    return shown.reshape(-1, 3)[: len(colours)].reshape(radiance.shape)


def _curves(mapping: bpy.types.CurveMapping) -> tuple[object, ...]:
    points = tuple((*point.location, point.handle_type) for curve in mapping.curves for point in curve.points)
    levels = (*mapping.black_level, *mapping.white_level, mapping.tone, mapping.use_clip, mapping.extend)
    return points + levels
