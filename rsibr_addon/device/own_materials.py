"""What an object's own materials are drawn from: their inputs, and their images on the GPU."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import gpu

from ..core.materials.principled import Input, PrincipledInputs, Texture

MOST_TEXTURES = 8
"""Textures that a material may sample; OpenGL grants 16 in all, and a pyramid takes 6."""

MOST_UV_MAPS = 4
"""UV maps that a mesh may have on the GPU."""


@dataclass(frozen=True, eq=False)
class DrawnMaterial:
    """One material.

    Attributes
    ----------
    inputs : PrincipledInputs
        Without `Baked`: whoever makes this has put something in its place.
    textures : mapping of Texture to GPUTexture
        The images of all textures that the inputs have, `MOST_TEXTURES` at most, in scene-linear colours.
    """

    inputs: PrincipledInputs
    textures: "Mapping[Texture, gpu.types.GPUTexture]" = field(default_factory=dict)

    @property
    def is_opaque(self) -> bool:
        """Whether its alpha is 1 everywhere."""
        alpha = self.inputs.alpha
        return isinstance(alpha, Input) and alpha.texture is None and alpha.constant[0] >= 1.0


@dataclass(frozen=True, eq=False)
class OwnMaterials:
    """The materials of an object's slots: a look of a kernel pyramid.

    Attributes
    ----------
    slots : tuple of DrawnMaterial
        At least one. Triangles of a slot beyond the last have the last one's, as in Blender.
    antialiased : bool
        Whether what a pixel's normals reflect is averaged.
    """

    slots: tuple[DrawnMaterial, ...]
    antialiased: bool = True

    @property
    def is_opaque(self) -> bool:
        """Whether all its materials are."""
        return all(material.is_opaque for material in self.slots)
