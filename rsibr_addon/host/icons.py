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
    pixels : ndarray, shape (height, width, 3)
        sRGB in [0, 1], row 0 at the bottom.

    Returns
    -------
    int
        Blender's number of the picture.
    """
    height, width = pixels.shape[:2]
    icon = icons.new(name)
    icon.image_size = width, height
    opaque = np.concatenate([pixels, np.ones((height, width, 1))], axis=-1)
    icon.image_pixels_float.foreach_set(opaque.astype(np.float32).ravel())
    number: int = icon.icon_id
    return number
