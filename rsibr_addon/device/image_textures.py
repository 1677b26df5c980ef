"""Blender's images on the GPU, as they are painted, reloaded and converted."""

from collections.abc import Callable, Iterator, Mapping
from typing import Any

import gpu

from ..core.materials.principled import Texture


class ImageTextures(Mapping[Texture, "gpu.types.GPUTexture"]):
    """The images of textures. Blender is asked for them each time, in half a microsecond, as it renews them.

    Parameters
    ----------
    textures : tuple of Texture
    image_of : callable
        The image of a texture. It has pixels.
    """

    def __init__(self, textures: tuple[Texture, ...], image_of: Callable[[Texture], Any]) -> None:
        self._textures, self._image_of = textures, image_of

    def __getitem__(self, texture: Texture) -> "gpu.types.GPUTexture":
        return gpu.texture.from_image(self._image_of(texture))

    def __iter__(self) -> Iterator[Texture]:
        return iter(self._textures)

    def __len__(self) -> int:
        return len(self._textures)
