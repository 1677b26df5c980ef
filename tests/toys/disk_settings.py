"""How the toy kind is made and compared. As a module of `settings`."""

from dataclasses import dataclass
from typing import ClassVar

from rsibr.rsibr_addon.core.options import option
from rsibr.rsibr_addon.settings.comparison import ComparisonOptions
from rsibr.rsibr_addon.settings.method import MethodSettings


@dataclass(frozen=True, kw_only=True)
class DiskSettings(MethodSettings):
    """Settings of disks."""

    KIND: ClassVar = "disk"
    LABEL: ClassVar = "Disk"
    SUMMARY: ClassVar = "Two colours"

    shine: float = option(0.5, label="Shine", help="Light of the rim", least=0.0, most=1.0)


@dataclass(frozen=True, kw_only=True)
class DiskComparison(ComparisonOptions):
    """How much brighter the truth is."""

    brighter: float = option(1.25, label="Brighter", help="Factor of the truth's radiance", least=0.0)
