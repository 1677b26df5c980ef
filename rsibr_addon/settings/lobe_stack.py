"""How an environment is filtered with the lobes of a material: [Kautz2000]."""

from dataclasses import dataclass, replace
from typing import Any, ClassVar

from ..core.errors import RangeError
from ..core.kinds.lobe_stack.stack import LARGEST
from ..core.options import Choice, declared_options, option
from .comparison import ExactComparison
from .fit import FITTING, MODEL_HELP, MODELS, Fitting
from .method import MethodSettings


def layout_option() -> Any:
    """How maps that are looked up along lobes' axes are laid out."""
    return option(
        "dual_paraboloid",
        label="Layout",
        help="How maps hold all directions",
        choices={
            "dual_paraboloid": Choice("Dual Paraboloid", "two disks, one for each hemisphere"),
            "octahedral": Choice("Octahedral", "one square for the whole sphere"),
        },
        advanced=True,
        stored="layout_of_maps",
    )


@dataclass(frozen=True, kw_only=True)
class LobeStackSettings(Fitting, MethodSettings):
    """Settings of lobe stacks: a model and how it is fitted, or a fit that was made before."""

    KIND: ClassVar = "lobe_stack"
    LABEL: ClassVar = "Lobe Stack"
    SUMMARY: ClassVar = "A glossy material's highlights, for each view elevation"

    brdf: str | None = option(
        None,
        label="Model",
        help=MODEL_HELP,
        none="that of the fit",
        metavar="SPEC",
        materials=replace(MODELS, instead="fit", spared=FITTING),
    )
    fit: str | None = option(
        None,
        label="Fit File",
        help="Lobes that were fitted before: a file by rsibr fit, or a map set that has lobes",
        none="fit the model",
        none_as="",
        subtype="FILE_PATH",
        metavar="FIT.json|NAME.rsibr.exr",
    )
    size: int | None = option(
        None,
        label="Size",
        help="Width of a map's sheets",
        unit="texels",
        least=2,
        most=LARGEST,
        none="what the lobes need",
        none_as=0,
        draft=32,
    )
    half: bool = option(
        True,
        label="Half Floats",
        help="Store 16-bit floats: half the space on disk, with 11 significant bits",
        final=False,
    )
    layout: str = layout_option()

    @property
    def expected(self) -> str:
        """See `MethodSettings`; measured in docs/lobe-stacks.md."""
        if self.brdf is None or self.method != "joint":
            return ""
        if self.lobes == 2 and self.size == 32:
            return "Two lobes in 32 texels are 3 % off for copper, 13 % for a lobe of alpha .04"
        if self.lobes >= 3 and self.size is None:
            return "Three lobes are 1 to 4 % off for copper, brushed metals, coats and car paint"
        return ""

    def __post_init__(self) -> None:
        super().__post_init__()
        if (self.brdf is None) is (self.fit is None):
            raise RangeError("A lobe stack is made of a reflectance model or of a fit: give one of them.")
        if self.fit is not None:
            given = [
                each.name for each in declared_options(Fitting) if getattr(self, each.name) != each.default
            ]
            if given:
                raise RangeError(
                    f"A fit has its own {', '.join(given)}: leave the options out, or give a BRDF."
                )


@dataclass(frozen=True, kw_only=True)
class StackComparison(ExactComparison):
    """How lobe stacks are compared with their reflectance model."""

    brdf: str | None = option(
        None,
        label="Model",
        help="The model that was baked, where it is in a file, as rsibr bake takes it",
        none="what the map set names",
        metavar="SPEC",
    )
