"""Eight car paints, as measured and fitted in [Guenther2005]."""

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

from ..conventions import Array
from ..errors import RangeError
from ..near_names import did_you_mean
from .cook_torrance import CookTorrance
from .fresnel import Schlick
from .lambert import Lambert
from .layered import Sum
from .model import Brdf, Geometry

_Rgb = tuple[float, float, float]

PAINTS: dict[str, tuple[_Rgb, tuple[tuple[_Rgb, float, float], ...]]] = {
    "ford_f8": (
        (0.0012, 0.0015, 0.0018),
        (
            ((0.0049, 0.0076, 0.012), 0.15, 0.32),
            ((0.01, 0.013, 0.018), 0.087, 0.11),
            ((0.007, 0.0065, 0.0077), 0.9, 0.013),
        ),
    ),
    "polaris_silber": (
        (0.055, 0.063, 0.071),
        (
            ((0.065, 0.082, 0.088), 1.0, 0.38),
            ((0.11, 0.11, 0.13), 0.92, 0.17),
            ((0.008, 0.013, 0.015), 0.9, 0.013),
        ),
    ),
    "opel_titan": (
        (0.011, 0.013, 0.015),
        (
            ((0.057, 0.066, 0.078), 0.85, 0.38),
            ((0.11, 0.12, 0.13), 0.86, 0.17),
            ((0.0095, 0.014, 0.016), 0.9, 0.014),
        ),
    ),
    "bmw_339": (
        (0.012, 0.015, 0.016),
        (
            ((0.062, 0.076, 0.08), 0.92, 0.39),
            ((0.11, 0.12, 0.12), 0.87, 0.17),
            ((0.0083, 0.015, 0.016), 0.9, 0.013),
        ),
    ),
    "2k_acrylack": (
        (0.42, 0.32, 0.1),
        (
            ((0.0, 0.0, 0.0), 1.0, 0.88),
            ((0.028, 0.026, 0.006), 0.9, 0.8),
            ((0.017, 0.0075, 0.0041), 0.17, 0.015),
        ),
    ),
    "white": (
        (0.61, 0.63, 0.55),
        (
            ((2.6e-6, 0.00031, 3.1e-8), 0.049, 1.0),
            ((0.013, 0.011, 0.0083), 0.45, 0.15),
            ((0.049, 0.042, 0.037), 0.17, 0.015),
        ),
    ),
    "blue": (
        (0.0079, 0.023, 0.1),
        (
            ((0.0011, 0.0015, 0.0019), 1.0, 0.15),
            ((0.025, 0.03, 0.043), 0.094, 0.043),
            ((0.059, 0.074, 0.082), 0.17, 0.02),
        ),
    ),
    "blue_matte": (
        (0.0099, 0.036, 0.12),
        (
            ((0.0032, 0.0045, 0.0059), 1.0, 0.16),
            ((0.18, 0.23, 0.28), 0.046, 0.075),
            ((0.04, 0.049, 0.051), 0.17, 0.034),
        ),
    ),
}
"""Paint -> diffuse colour; and per lobe its colour ks, Schlick's f0, and Beckmann's alpha.

[Guenther2005] table 1, as LuxCoreRender carries it (its material carpaint), whose scaling of the lobes is
`CookTorrance`'s.
"""


@dataclass(frozen=True, kw_only=True)
class CarPaint(Brdf):
    """One of the measured `PAINTS`: Lambert plus three Cook-Torrance lobes, from flakes to clear coat.

    Notes
    -----
    [Guenther2005] section 4.
    """

    model: ClassVar[str] = "car_paint"
    name: str

    def __post_init__(self) -> None:
        if self.name not in PAINTS:
            near = did_you_mean(self.name, PAINTS)
            raise RangeError(f'There is no car paint "{self.name}"{near}: choose one of {", ".join(PAINTS)}.')

    def above_horizon(self, geometry: Geometry) -> Array:
        """See `Brdf`."""
        return self._sum.above_horizon(geometry)

    @property
    def layers(self) -> tuple[Brdf, ...]:
        """Diffuse part, and those of its lobes that are not black."""
        return self._sum.layers

    @cached_property
    def _sum(self) -> Sum:
        kd, lobes = PAINTS[self.name]
        glossy = (
            CookTorrance(alpha=alpha, fresnel=Schlick(f0=f0), ks=ks) for ks, f0, alpha in lobes if any(ks)
        )
        return Sum(parts=(Lambert(kd=kd), *glossy))
