"""Settings and files of all our renders."""

from pathlib import Path

import bpy
import numpy as np

from ..core.conventions import Array
from ..core.errors import RenderError
from ..core.threads import limited, thread_count
from ..files.exr import read_parts
from ..files.temporary import temporary_folder

AXES = "RGBAXYZ"
"""Order of the channels of a pass."""


def configure_cycles(scene: bpy.types.Scene, width: int, height: int, samples: int) -> None:
    """Have Cycles render on the CPU, each pixel the plain mean of its samples."""
    render, cycles = scene.render, scene.cycles
    render.engine = "CYCLES"
    if limited():
        render.threads_mode, render.threads = "FIXED", thread_count()
    render.resolution_x, render.resolution_y, render.resolution_percentage = width, height, 100
    cycles.device = "CPU"
    cycles.samples = samples
    cycles.use_adaptive_sampling = False
    cycles.use_denoising = False
    cycles.sampling_pattern = "TABULATED_SOBOL"
    cycles.pixel_filter_type = "BOX"
    cycles.max_bounces = 0
    # Each of these would save time but lose light.
    cycles.light_sampling_threshold = 0.0
    cycles.sample_clamp_direct = 0.0


def render_to(scene: bpy.types.Scene, path: Path) -> None:
    """Render a scene, at its current frame, into a file in the scene's format.

    Parameters
    ----------
    scene : bpy.types.Scene
    path : Path
        Does not exist yet.

    Raises
    ------
    RenderError
        The render leaves no file.
    """
    scene.render.filepath = str(path)
    scene.render.use_file_extension = False
    try:
        # Blender would set a scene given by name to the frame of the artist's scene.
        with bpy.context.temp_override(scene=scene):
            bpy.ops.render.render(write_still=True)
    except RuntimeError as error:
        told = str(error).strip().removeprefix("Error: ").rstrip(".")
        raise RenderError(f"Blender cannot render: {told}.") from error
    if not path.exists():
        raise RenderError("Blender's render was cancelled, or another one is going on: try again.")


def render_passes(scene: bpy.types.Scene) -> dict[str, Array]:
    """Render a scene, and read every pass of it.

    Parameters
    ----------
    scene : bpy.types.Scene
        Has one view layer, without a full stop in its name.

    Returns
    -------
    dict of str to ndarray, shape (height, width, channels), float32
        Pass -> pixels in the working colour space, row 0 at the bottom: "Combined" has R, G, B, A.

    Raises
    ------
    RenderError
        See `render_to`.
    """
    image = scene.render.image_settings
    image.media_type, image.file_format, image.color_depth = "MULTI_LAYER_IMAGE", "OPEN_EXR_MULTILAYER", "32"
    channels: dict[str, dict[str, Array]] = {}
    with temporary_folder() as folder:
        path = folder / "passes.exr"
        render_to(scene, path)
        for part in read_parts(path):
            for name, pixels in part.channels.items():
                of_pass, _, axis = name.partition(".")[2].rpartition(".")
                channels.setdefault(of_pass, {})[axis] = pixels
    return {
        of_pass: np.stack([pixels[axis] for axis in sorted(pixels, key=AXES.index)], axis=-1)
        for of_pass, pixels in channels.items()
    }


def render_frame(
    scene: bpy.types.Scene, number: int, picture_format: str, path: Path, samples: int | None
) -> None:
    """Render a frame of a scene, which has our engine, into a file of a format of Blender's.

    Parameters
    ----------
    scene : bpy.types.Scene
        Its settings are changed, and the open file is at this frame afterwards.
        The file has one picture, without stereoscopy.
    number : int
    picture_format : {"OPEN_EXR", "PNG"}
        EXR has 32-bit floats.
    path : Path
        Does not exist yet.
    samples : int or None
        None for the scene's.

    Raises
    ------
    RenderError
        See `render_to`.
    """
    if samples is not None:
        scene.rsibr_render.samples = samples
    image = scene.render.image_settings
    image.media_type, image.file_format = "IMAGE", picture_format
    image.color_mode = "RGBA" if scene.render.film_transparent else "RGB"
    image.color_depth = "32" if picture_format == "OPEN_EXR" else "8"
    scene.render.use_multiview = False
    scene.frame_set(number)
    render_to(scene, path)
