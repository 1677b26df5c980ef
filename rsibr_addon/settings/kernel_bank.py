"""How an environment is filtered for any material."""

from dataclasses import dataclass
from typing import ClassVar

from ..core.kinds.lobe_stack.stack import LARGEST
from ..core.options import option
from .lobe_stack import layout_option
from .method import MethodSettings


@dataclass(frozen=True, kw_only=True)
class KernelBankSettings(MethodSettings):
    """Settings of kernel banks."""

    KIND: ClassVar = "kernel_bank"
    LABEL: ClassVar = "Kernel Bank"
    SUMMARY: ClassVar = "Light alone, for any reflectance model: chosen while you look"
    REMARK: ClassVar = "A kernel bank is for any material: choose a model in Look."

    size: int = option(
        128,
        label="Size",
        help="Width of a map's sheets; sharper materials need more",
        unit="texels",
        least=2,
        most=LARGEST,
        offered=(64, 128, 256, 512),
        draft=64,
        final=256,
    )
    layout: str = layout_option()
