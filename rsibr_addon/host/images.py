"""Images that materials name."""

import bpy

from ..core.materials.principled import Texture


def image_of(texture: Texture) -> bpy.types.Image | None:
    """The image that a texture names; None where there is none any more."""
    image: bpy.types.Image | None = bpy.data.images.get((texture.image, texture.library or None))
    return image


def has_pixels(image: bpy.types.Image | None) -> bool:
    """Whether an image can be shown; it is read from its file where it was not yet."""
    return image is not None and all(image.size)
