"""A Principled material as it is described: each input a constant, an image, or something to be baked.

Descriptions are compared by value: equal ones look the same as long as their images do.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

Row = tuple[float, float, float, float, float]
"""Factors of a texel's red, green, blue and alpha, and a number that is added."""

Affine = tuple[float, float, float, float, float, float]
"""Rows (a, b, c), (d, e, f): a point (u, v) goes to (a u + b v + c, d u + e v + f)."""

Extension = Literal["REPEAT", "EXTEND", "CLIP", "MIRROR"]

IDENTITY: Affine = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0)


@dataclass(frozen=True)
class Texture:
    """An image, and where on a surface its texels lie.

    Attributes
    ----------
    image : str
        Name of the image; of a bake, that of its picture.
    library : str
        File that it is linked from; empty for an image of the open file.
    uv_map : str
        Name of the UV map, or of a bake's own unwrapping; empty for the one that the mesh renders with.
    mapping : Affine
        From the UV map to the image, whose lower left corner is (0, 0) and upper right one (1, 1).
    extension : {"REPEAT", "EXTEND", "CLIP", "MIRROR"}
        What lies outside of the image.
    closest : bool
        Whether a texel is one colour all over; bilinear otherwise.
    bake : str
        File of baked inputs that it is a picture of (`files.baked_inputs`); empty for an image of Blender's.
    covered : bool
        Whether colours are multiplied by alpha.
    """

    image: str
    library: str = ""
    uv_map: str = ""
    mapping: Affine = IDENTITY
    extension: Extension = "REPEAT"
    closest: bool = False
    bake: str = ""
    covered: bool = False

    @property
    def is_premultiplied(self) -> bool:
        """Whether colours are multiplied by alpha before they are interpolated."""
        return self.covered and not self.closest


@dataclass(frozen=True)
class Input:
    """One input: numbers that are affine in an image's texels, or constant.

    Attributes
    ----------
    rows : tuple of Row
        One for each number: three of a colour or vector, one of a value.
    texture : Texture, optional
        None for a constant.
    """

    rows: tuple[Row, ...]
    texture: Texture | None = None

    @property
    def constant(self) -> tuple[float, ...]:
        """The numbers without the texture's part."""
        return tuple(row[4] for row in self.rows)

    @property
    def least(self) -> tuple[float, ...]:
        """The smallest numbers that texels within 0 and 1 can give."""
        return tuple(row[4] + sum(min(factor, 0.0) for factor in row[:4]) for row in self.rows)


def constant(numbers: Sequence[float]) -> Input:
    """An input without an image."""
    return Input(tuple((0.0, 0.0, 0.0, 0.0, float(number)) for number in numbers))


@dataclass(frozen=True)
class Baked:
    """An input that only Cycles can evaluate.

    Attributes
    ----------
    reason : str
        What cannot be followed, as the part of a sentence: "Noise Texture".
    apart : bool
        Whether Cycles evaluates it apart from others, as it does where shaders are mixed.
    """

    reason: str
    apart: bool = False


@dataclass(frozen=True)
class NormalMap:
    """A normal map in tangent space.

    Attributes
    ----------
    color : Input
        Encodes the normal as 0.5 + 0.5 n.
    strength : Input
    uv_map : str
        UV map of the tangents; empty for the one that the mesh renders with.
    """

    color: Input
    strength: Input
    uv_map: str = ""


@dataclass(frozen=True)
class Bump:
    """A height above the surface.

    Attributes
    ----------
    height, strength, distance : Input
        The height is `height` times `distance`, in world units.
    invert : bool
    normal : NormalMap, optional
        What is bumped, where that is not the surface's own normal.
    """

    height: Input
    strength: Input
    distance: Input
    invert: bool = False
    normal: NormalMap | None = None


Shading = Input | Baked
Normal = NormalMap | Bump | Baked | None


@dataclass(frozen=True)
class PrincipledInputs:
    """All inputs of a Principled BSDF that reflection and emission need.

    Attributes
    ----------
    base_color, ..., alpha : Input or Baked
        As the node has them, not clamped.
    normal, coat_normal : NormalMap, Bump or Baked, optional
        None for the surface's own normal.
    missing : tuple of str
        What the material has and is not shown.
    """

    base_color: Shading
    metallic: Shading
    roughness: Shading
    ior: Shading
    specular_level: Shading
    specular_tint: Shading
    diffuse_roughness: Shading
    coat_weight: Shading
    coat_roughness: Shading
    coat_ior: Shading
    coat_tint: Shading
    sheen_weight: Shading
    sheen_roughness: Shading
    sheen_tint: Shading
    emission_color: Shading
    emission_strength: Shading
    alpha: Shading
    normal: Normal
    coat_normal: Normal
    missing: tuple[str, ...] = ()
