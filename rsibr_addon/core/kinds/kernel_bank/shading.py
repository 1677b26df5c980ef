"""Shading from a kernel bank: as the lobe stack of a reflectance model that is chosen in the preview."""

from dataclasses import dataclass

from ...brdf.spec import with_alpha
from ...errors import RangeError

MOST_LOBES = 12


@dataclass(frozen=True)
class BankLook:
    """Look of a kernel bank.

    Attributes
    ----------
    brdf : str
        The reflectance model: see `core/brdf/spec.py`.
    roughness : float or None
        In (0, 1]; its square becomes every alpha of the model. None keeps the model's own.
    lobe_count : int
        Lobes for each layer of the model, 1 to `MOST_LOBES`.

    Raises
    ------
    RangeError
        A number is out of range, or the model has no alpha to set.

    Notes
    -----
    Radiance is that of `shading.lobe_stack.stack_radiance`, of what `lobes.filtered_bank.stack_from_bank`
    sums.
    """

    brdf: str = "ggx:alpha=0.3,metal=copper"
    roughness: float | None = None
    lobe_count: int = 3

    def __post_init__(self) -> None:
        if not 1 <= self.lobe_count <= MOST_LOBES:
            raise RangeError(f"{self.lobe_count} lobes are out of range: choose 1 to {MOST_LOBES}.")
        if self.roughness is not None:
            if not 0.0 < self.roughness <= 1.0:
                raise RangeError(
                    f"A roughness of {self.roughness:g} is out of range: choose one above 0, up to 1."
                )
            with_alpha(self.brdf, self.roughness**2)

    @property
    def spec(self) -> str:
        """The model with its roughness."""
        return self.brdf if self.roughness is None else with_alpha(self.brdf, self.roughness**2)
