"""Shading from a kernel bank: as the lobe stack of a reflectance model that is chosen in the preview."""

from dataclasses import dataclass, fields

from ...brdf.spec import with_alpha
from ...options import Choice, option
from ..principled_material import PrincipledMaterial

DRAFT = (1, 6, 1)
"""Lobes, elevations and taps of what is shown until a fit is there, and of small pictures."""


@dataclass(frozen=True)
class BankLook(PrincipledMaterial):
    """What a kernel bank is shaded as: a Principled material, or any model by its text.

    Raises
    ------
    RangeError
        A number is out of range, or the model has no alpha to set.

    Notes
    -----
    Radiance is that of `core.kinds.lobe_stack.shading.stack_radiance`, of what
    `filtered_bank.stack_from_bank` sums.
    """

    roughness: float | None = option(  # type: ignore[assignment]  # of a model by its text it may be unknown
        None,
        label="Roughness",
        help="Roughness of the material, or of all layers of a model; their alpha is its square",
        least=1e-3,
        most=1.0,
        none="the model's own; 0.5 of a Principled material",
        switch=Choice("Set Roughness", "Give the material the roughness below"),
        start=0.5,
        soft_least=0.1,
        metavar="R",
    )
    brdf: str | None = option(
        None,
        label="Model",
        help="Reflectance model and its parameters, as ggx:alpha=0.1,metal=gold",
        none="the Principled material that the other options say",
        none_as="",
        advanced=True,
        metavar="SPEC",
    )
    lobe_count: int = option(
        3,
        label="Lobes",
        help="Lobes for each layer of the model; more follow its reflectance more closely, and take longer",
        least=1,
        most=12,
        advanced=True,
        metavar="J",
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        _ = self.spec

    @property
    def spec(self) -> str:
        """The model with its roughness."""
        if self.brdf is None:
            given = {each.name: getattr(self, each.name) for each in fields(PrincipledMaterial)}
            if self.roughness is None:
                del given["roughness"]
            return PrincipledMaterial(**given).text
        return self.brdf if self.roughness is None else with_alpha(self.brdf, self.roughness**2)
