"""Blender's images on the GPU, as they are painted, reloaded and converted."""

from collections.abc import Callable, Iterator, Mapping
from typing import Any

import gpu

from ..core.materials.principled import Texture
from .textures import GpuTexture


class ImageTextures(Mapping[Texture, "gpu.types.GPUTexture"]):
    """The images of textures. Blender is asked for them each time, in half a microsecond, as it renews them.

    Parameters
    ----------
    textures : tuple of Texture
    image_of : callable
        The image of a texture. It has pixels.
    baked : mapping of Texture to GpuTexture
        The images of those that are bakes, whole.
    """

    def __init__(
        self,
        textures: tuple[Texture, ...],
        image_of: Callable[[Texture], Any],
        baked: Mapping[Texture, GpuTexture],
    ) -> None:
        self._textures, self._image_of, self._baked = textures, image_of, baked

    def __getitem__(self, texture: Texture) -> "gpu.types.GPUTexture":
        if texture.bake:
            return self._baked[texture].whole()
        return gpu.texture.from_image(self._image_of(texture))

    def __iter__(self) -> Iterator[Texture]:
        return iter(self._textures)

    def __len__(self) -> int:
        return len(self._textures)
