"""What is chosen of an export for an engine."""

from dataclasses import dataclass

from ....core.kinds.mip_chain.chain import LARGEST, check_size
from ....core.options import Options, option


@dataclass(frozen=True, kw_only=True)
class CubeSettings(Options):
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
