"""How an environment is filtered for Principled materials."""

from dataclasses import dataclass
from typing import ClassVar

from ..core.kinds.principled_material import PrincipledMaterial
from ..core.options import option
from .comparison import ExactComparison
from .method import MethodSettings


@dataclass(frozen=True, kw_only=True)
class KernelPyramidSettings(MethodSettings):
    """Settings of kernel pyramids."""

    KIND: ClassVar = "kernel_pyramid"
    LABEL: ClassVar = "Own Materials"
    SUMMARY: ClassVar = "Light alone: each object keeps its own Principled materials, textures and all"
    REMARK: ClassVar = "Each object keeps its own Principled materials; nothing of them is baked."

    size: int = option(
        1024,
        label="Size",
        help="Width of the sharpest maps; smooth metals under a small sun need more",
        unit="texels",
        least=32,
        most=2048,
        offered=(256, 512, 1024, 2048),
        draft=512,
        final=2048,
    )

    @property
    def expected(self) -> str:
        """See `MethodSettings`; measured in docs/materials.md."""
        return "Principled materials are 0.1 to 3 % off" if self.size >= 1024 else ""


@dataclass(frozen=True, kw_only=True)
class PyramidComparison(ExactComparison, PrincipledMaterial):
    """How one material, shaded from a pyramid, is compared with its reflectance model."""
