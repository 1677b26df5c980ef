"""How inputs of materials are baked that no image says."""

from dataclasses import dataclass
from typing import ClassVar

from ..core.options import Options, option
from .method import MethodSettings


@dataclass(frozen=True, kw_only=True)
class BakedInputsSettings(Options):
    """Settings of the pictures of baked inputs."""

    size: int = option(
        1024,
        label="Size",
        help="Width and height of the pictures of what no image says of a material",
        unit="texels",
        least=16,
        most=8192,
        draft=512,
        final=2048,
    )
    samples: int = option(
        4,
        label="Samples",
        help="Samples of Cycles for each texel: more of them smooth edges and grain",
        least=1,
        most=1 << 12,
        draft=1,
        final=16,
    )


@dataclass(frozen=True, kw_only=True)
class ObjectInputsSettings(BakedInputsSettings, MethodSettings):
    """The same, of an object: what a job has baked."""

    KIND: ClassVar = "inputs"
    LABEL: ClassVar = "Textures of materials"
    SUMMARY: ClassVar = "What no image says of an object's materials, in pictures for previews"

    object: str = option(label="Object", help="Name of the object, in the open file")
