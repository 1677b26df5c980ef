"""Microfacets with Beckmann's distribution and the shadowing of V-shaped grooves."""

from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np

from ..conventions import Array
from .fresnel import Fresnel
from .model import Brdf, Geometry
from .parameters import Color, Range


@dataclass(frozen=True, kw_only=True)
class CookTorrance(Brdf):
    """Rough metal or dielectric: one reflection off Beckmann's microfacets, scaled by ks.

    ks F D G / (4 n.l n.v) with D = exp(-tan^2(h) / alpha^2) / (pi alpha^2 cos^4(h)), which times the cosine
    integrates to 1. With [Cook1982]'s unscaled D and 1/pi instead, a mirror would reflect four times the
    light that it receives.

    Notes
    -----
    [Cook1982] sections 2 and 3; scaled as in [Walter2007] Eq. 20, 25.
    """

    model: ClassVar[str] = "cook_torrance"
    alpha: Annotated[float, Range(0.0, 1.0, low_open=True)]
    fresnel: Fresnel
    ks: Annotated[Color, Range(0.0, 1.0)] = 1.0

    def above_horizon(self, geometry: Geometry) -> Array:
        """See `Brdf`."""
        n_dot_h, n_dot_l, n_dot_v = geometry.n_dot_h, geometry.n_dot_l, geometry.n_dot_v
        slope2 = geometry.half_sine_squared / n_dot_h**2
        ndf = np.exp(-slope2 / self.alpha**2) / (np.pi * self.alpha**2 * n_dot_h**4)
        # The other side of a groove may hide a facet, from the light or from the view
        grooves = np.minimum(1.0, 2.0 * n_dot_h * np.minimum(n_dot_l, n_dot_v) / geometry.h_dot_l)
        facets = ndf * grooves / (4.0 * n_dot_l * n_dot_v)
        brdf: Array = np.asarray(self.ks) * facets[:, None] * self.fresnel(geometry.h_dot_l)
        return brdf
