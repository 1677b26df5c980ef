"""A cosine lobe about the view direction: paint with glass beads, or the moon."""

from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np

from ..conventions import Array
from .model import Brdf, Geometry
from .parameters import Color, Range
from .phong import cosine_lobe


@dataclass(frozen=True, kw_only=True)
class Retroreflective(Brdf):
    """Light reflected back to its source: ks (n + 2) / 2pi max(0, light . view)^n.

    Modified Phong with the light on the other side of the normal, so its albedo is the same.

    Notes
    -----
    [Lafortune1997] section 4.2, its generalised cosine lobe with Cx = Cy = Cz = 1.
    """

    model: ClassVar[str] = "retroreflective"
    n: Annotated[float, Range(0.0, 1e6)]
    ks: Annotated[Color, Range(0.0, 1.0)]

    def above_horizon(self, geometry: Geometry) -> Array:
        """See `Brdf`."""
        return np.asarray(self.ks) * cosine_lobe(geometry.l_dot_v, self.n)
