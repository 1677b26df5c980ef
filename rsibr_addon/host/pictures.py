"""Radiance as pictures for people: PNG through Blender's view transform."""

import errno
import shutil
from pathlib import Path

import bpy
import numpy as np

from ..core.conventions import Array
from ..files.temporary import temporary_folder
from .scenes import temporary_scene
from .working_space import working_from_rec709


def save_png(path: Path, rgba: Array, exposure: float = 0.0, view_transform: str = "Standard") -> None:
    """Write scene-linear radiance as an 8-bit sRGB picture.

    Parameters
    ----------
    path : Path
        Written as it is, replaced if it exists.
    rgba : ndarray, shape (height, width, 4)
        Scene-linear Rec. 709 radiance premultiplied by coverage, and coverage in [0, 1]; row 0 is
        the bottom row.
    exposure : float
        In stops.
    view_transform : str
        As Blender names it.

    Raises
    ------
    OSError
        It cannot be written there: the folder is missing, the disk full.
    OutputFileError
        The disk with temporary files is full.

    Notes
    -----
    By default the sRGB curve of radiance clipped to [0, 1] and nothing else, so 0.18 becomes 118 of 255;
    without dither. Alpha is straight, as PNG has it. Blender writes into a temporary folder, because it cuts
    paths off after 1023 bytes.
    """
    height, width = rgba.shape[:2]
    with temporary_folder() as folder, temporary_scene() as scene:
        scene.display_settings.display_device = "sRGB"
        scene.view_settings.view_transform = view_transform
        scene.view_settings.exposure = exposure
        scene.render.dither_intensity = 0.0
        settings = scene.render.image_settings
        settings.media_type = "IMAGE"
        settings.file_format, settings.color_mode, settings.color_depth = "PNG", "RGBA", "8"
        image = bpy.data.images.new(path.name, width, height, alpha=True, float_buffer=True)
        image.alpha_mode = "PREMUL"
        working = np.array(rgba, dtype=np.float32)
        working[..., :3] = working_from_rec709(working[..., :3])
        image.pixels.foreach_set(working.ravel())
        picture = folder / "picture.png"
        try:
            image.save_render(str(picture), scene=scene)
        except RuntimeError as error:
            raise OSError(errno.EIO, "Blender cannot write the picture", str(path)) from error
        # Blender does not report a full disk; a PNG without its last chunk does.
        if picture.read_bytes()[-8:-4] != b"IEND":
            raise OSError(errno.ENOSPC, "the picture is not whole", str(path))
        shutil.move(picture, path)
