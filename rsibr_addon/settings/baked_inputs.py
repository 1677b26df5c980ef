"""How inputs of materials are baked that no image says."""

from dataclasses import dataclass

from ..core.options import Options, option


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
