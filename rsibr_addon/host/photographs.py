"""Pictures that are not radiance yet: JPEG, PNG and whatever else Blender reads."""

from pathlib import Path

import bpy
import numpy as np

from ..core.conventions import Array
from ..core.errors import InputFileError
from ..core.transfer_curve import linear_from_srgb
from .scenes import temporary_scene


def read_photograph(path: Path) -> Array:
    """Read a picture of 8 or 16 bits, and undo its curve.

    Parameters
    ----------
    path : Path
        Of any kind that Blender reads; taken as sRGB, whatever profile it states. Alpha is left out.

    Returns
    -------
    ndarray, shape (height, width, 3), float32
        In [0, 1], proportional to radiance in linear Rec. 709, row 0 at the bottom.

    Raises
    ------
    InputFileError
        The file is missing, or no picture.
    """
    return linear_from_srgb(read_encoded(path)).astype(np.float32)


def read_encoded(path: Path) -> Array:
    """Read a picture of 8 or 16 bits with the curve that it is stored with.

    Parameters
    ----------
    path : Path
        Of any kind that Blender reads. Alpha is left out.

    Returns
    -------
    ndarray, shape (height, width, 3), float32
        In [0, 1], row 0 at the bottom.

    Raises
    ------
    InputFileError
        The file is missing, or no picture.
    """
    with temporary_scene():
        encoded = stored_numbers(path)[..., :3]
    return np.broadcast_to(encoded, (*encoded.shape[:2], 3))


def stored_numbers(path: Path) -> Array:
    """Read a picture of 8 or 16 bits as it is; within `scenes.temporary_scene` no trace of it stays.

    Parameters
    ----------
    path : Path

    Returns
    -------
    ndarray, shape (height, width, channels), float32
        In [0, 1], row 0 at the bottom.

    Raises
    ------
    InputFileError
        The file is missing, or no picture.
    """
    try:
        image = bpy.data.images.load(str(path.resolve()))
    except RuntimeError as error:
        raise InputFileError(f"{path} cannot be read as a picture: check the file.") from error
    # Numbers as they are stored: otherwise Blender decodes 16 bits, but not 8.
    image.colorspace_settings.name = "Non-Color"
    image.alpha_mode = "CHANNEL_PACKED"
    width, height = image.size
    pixels: Array = np.empty(width * height * image.channels, dtype=np.float32)
    if not pixels.size:
        raise InputFileError(f"{path} cannot be read as a picture: check the file.")
    image.pixels.foreach_get(pixels)
    return pixels.reshape(height, width, -1)
