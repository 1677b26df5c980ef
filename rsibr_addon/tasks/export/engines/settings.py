"""What is chosen of an export for an engine."""

from dataclasses import dataclass

from ....core.errors import RangeError
from ....core.kinds.mip_chain.chain import LARGEST, check_size
from ....core.options import Choice, Options, option
from ....files.textures import Up


@dataclass(frozen=True, kw_only=True)
class EngineSettings(Options):
    """What is chosen of an export for an engine: nothing, where it takes the environment as it is."""


@dataclass(frozen=True, kw_only=True)
class CubeSettings(EngineSettings):
    """How large a cube is."""

    size: int | None = option(
        None,
        label="Size",
        help="Width of the sharpest mip's faces, a power of 2",
        unit="texels",
        least=1,
        most=LARGEST,
        none="that of the mip chain, or 256",
        none_as=0,
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.size is not None:
            check_size(self.size, 1)


@dataclass(frozen=True, kw_only=True)
class LobesSettings(EngineSettings):
    """How large maps are."""

    widest: int | None = option(
        None,
        label="Widest Map",
        help="Width of the sharpest maps; those of Own Materials stay as they are",
        unit="texels",
        least=32,
        most=2048,
        none="512",
        none_as=0,
    )


@dataclass(frozen=True, kw_only=True)
class AnySettings(CubeSettings):
    """What an engine that has no preset wants."""

    up: Up = option(
        Up.Y,
        label="Up",
        help="Axis that points up where cubes are looked up",
        choices={Up.Z: Choice("Z", "as in Blender"), Up.Y: Choice("Y", "as in glTF")},
    )
    mirror: str = option(
        "none",
        label="Mirror",
        help="Axis that is turned over in lookups, after that",
        choices={"none": Choice("None"), "x": Choice("X"), "y": Choice("Y"), "z": Choice("Z")},
        metavar="AXIS",
    )
    rule: str = option(
        "linear",
        label="Rule",
        help="How roughness grows from mip to mip",
        choices={
            "linear": Choice("Linear", "mip / last"),
            "quadratic": Choice("Quadratic", "1 - sqrt(1 - mip / last)"),
        },
        metavar="RULE",
    )
    last: int = option(
        8,
        label="Last Mip",
        help="Width of the last mip, of roughness 1, a power of 2",
        unit="texels",
        least=1,
        most=LARGEST // 2,
    )
    texels: str = option(
        "half",
        label="Texels",
        help="What holds a texel",
        choices={
            "half": Choice("Floats", "16 bits a channel, in KTX 2.0 32 where light needs them"),
            "bc6h": Choice("BC6H", "compressed to a byte a texel"),
        },
        metavar="TEXELS",
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.last & (self.last - 1):
            raise RangeError(f"A last mip cannot be {self.last} texels wide: choose a power of 2.")
