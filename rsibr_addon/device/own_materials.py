"""What an object's own materials are drawn from: their inputs, and their images on the GPU."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import gpu

from ..core.materials.principled import Baked, Bump, Input, PrincipledInputs, Texture

MOST_TEXTURES = 8
"""Textures that a material may sample; OpenGL grants 16 in all, and a pyramid takes 7."""

MOST_UV_MAPS = 4
"""UV maps that a mesh may have on the GPU."""

TRANSLUCENT, SHEENLESS, UNCOATED, SMOOTH_DIFFUSE = "TRANSLUCENT", "SHEENLESS", "UNCOATED", "SMOOTH_DIFFUSE"
UNBUMPED, TEXTURES, FIRST_COVERED = "UNBUMPED", "TEXTURES", "FIRST_COVERED"
"""What programs may have defined: see `DrawnMaterial.defines`."""

_COUNTS = 0, 4
"""Numbers of textures that there are programs for, besides `MOST_TEXTURES`."""


@dataclass(frozen=True, eq=False)
class DrawnMaterial:
    """One material.

    Attributes
    ----------
    inputs : PrincipledInputs
        Without `Baked`: whoever makes this has put something in its place.
    textures : mapping of Texture to GPUTexture
        The images of all textures that the inputs have, `MOST_TEXTURES` at most, in scene-linear colours; in
        the order of `textured_materials.textures_of`.
    """

    inputs: PrincipledInputs
    textures: "Mapping[Texture, gpu.types.GPUTexture]" = field(default_factory=dict)

    @property
    def is_opaque(self) -> bool:
        """Whether its alpha is 1 everywhere."""
        alpha = self.inputs.alpha
        return isinstance(alpha, Input) and alpha.texture is None and alpha.constant[0] >= 1.0

    @cached_property
    def defines(self) -> tuple[str, ...]:
        """What its program has defined: names, or names with numbers behind them.

        A program without sheen, a coat, rough facets, bumps, more than `TEXTURES` textures, or textures up to
        `FIRST_COVERED` that are multiplied by alpha before they are interpolated, is a good deal faster than
        one in which nothing comes of them: drivers compute both ways of a branch. One with `TRANSLUCENT`
        leaves out what covers nothing, and draws what covers all if its constant `whole` is 1, and the rest
        if that is 0. A program that leaves fragments out is a fifth slower, everywhere.
        """
        wanted = {
            TRANSLUCENT: not self.is_opaque,
            SHEENLESS: _is_zero(self.inputs.sheen_weight),
            UNCOATED: _is_zero(self.inputs.coat_weight),
            SMOOTH_DIFFUSE: _is_zero(self.inputs.diffuse_roughness),
            UNBUMPED: not isinstance(self.inputs.normal, Bump),
        }
        names = [name for name, is_so in wanted.items() if is_so]
        count = next((each for each in _COUNTS if each >= len(self.textures)), MOST_TEXTURES)
        covered = (number for number, each in enumerate(self.textures) if each.is_premultiplied)
        return *names, f"{TEXTURES} {count}", f"{FIRST_COVERED} {next(covered, MOST_TEXTURES)}"


def _is_zero(value: Input | Baked) -> bool:
    return isinstance(value, Input) and value.texture is None and not any(value.constant)


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
