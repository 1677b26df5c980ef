"""How an environment is filtered for Principled materials."""

from dataclasses import dataclass
from typing import ClassVar

from .method import MethodSettings


@dataclass(frozen=True, kw_only=True)
class KernelPyramidSettings(MethodSettings):
    """Settings of kernel pyramids, which are as sharp as their environment."""

    KIND: ClassVar = "kernel_pyramid"
    LABEL: ClassVar = "Own Materials"
    SUMMARY: ClassVar = "Light alone: each object keeps its own Principled materials, textures and all"
    REMARK: ClassVar = "Each object keeps its own Principled materials; nothing of them is baked."
