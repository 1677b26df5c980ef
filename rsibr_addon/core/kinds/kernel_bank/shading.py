"""Shading from a kernel bank: as the lobe stack of a reflectance model that is chosen in the preview."""

from dataclasses import dataclass

from ...brdf.spec import with_alpha
from ...options import Choice, Options, option


@dataclass(frozen=True)
class BankLook(Options):
    """What a kernel bank is shaded as.

    Raises
    ------
    RangeError
        A number is out of range, or the model has no alpha to set.

    Notes
    -----
    Radiance is that of `core.kinds.lobe_stack.shading.stack_radiance`, of what
    `filtered_bank.stack_from_bank` sums.
    """

    brdf: str = option(
        "ggx:alpha=0.3,metal=copper",
        label="Model",
        help="Reflectance model and its parameters, as ggx:alpha=0.1,metal=gold",
        metavar="SPEC",
    )
    roughness: float | None = option(
        None,
        label="Roughness",
        help="Roughness of the model's layers; their alpha is its square",
        least=1e-3,
        most=1.0,
        none="the model's own",
        switch=Choice("Set Roughness", "Give every layer of the model the roughness below"),
        start=0.5,
        soft_least=0.1,
        metavar="R",
    )
    lobe_count: int = option(
        3,
        label="Lobes",
        help="Lobes for each layer of the model; more follow its reflectance more closely, and take longer",
        least=1,
        most=12,
        metavar="J",
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.roughness is not None:
            with_alpha(self.brdf, self.roughness**2)

    @property
    def spec(self) -> str:
        """The model with its roughness."""
        return self.brdf if self.roughness is None else with_alpha(self.brdf, self.roughness**2)
