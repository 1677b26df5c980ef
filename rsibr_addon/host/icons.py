"""Pictures for panels."""

import bpy.utils.previews
import numpy as np

from ..core.conventions import Array


def add_icon(icons: bpy.utils.previews.ImagePreviewCollection, name: str, pixels: Array) -> int:
    """Add a picture to a collection.

    Parameters
    ----------
    icons : ImagePreviewCollection
        Keeps the picture until it is removed or cleared.
    name : str
        New in the collection.
    pixels : ndarray, shape (height, width, 3 or 4)
        sRGB in [0, 1], and coverage; row 0 at the bottom.

    Returns
    -------
    int
        Blender's number of the picture.
    """
    height, width = pixels.shape[:2]
    icon = icons.new(name)
    icon.image_size = width, height
    rgba: Array = np.ones((height, width, 4), dtype=np.float32)
    rgba[..., : pixels.shape[2]] = pixels
    icon.image_pixels_float.foreach_set(rgba.ravel())
    number: int = icon.icon_id
    return number
