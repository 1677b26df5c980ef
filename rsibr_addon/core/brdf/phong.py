"""Phong's cosine lobe about the mirror direction, made reciprocal and energy-conserving."""

from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np

from ..conventions import Array
from .lambert import GlossyOverLambert
from .model import Geometry
from .parameters import Color, Range


def cosine_lobe(cosine: Array, n: float) -> Array:
    """A power of a cosine, scaled so that its lobe about the normal has albedo 1.

    Parameters
    ----------
    cosine : ndarray, shape (N,)
        Between light and the lobe's axis; 0 is returned where it is negative.
    n : float
        Exponent, at least 0.

    Returns
    -------
    ndarray, shape (N, 1)
        (n + 2) / 2pi cosine^n [1/sr].
    """
    lobe: Array = (n + 2.0) / (2.0 * np.pi) * np.maximum(cosine, 0.0)[:, None] ** n
    return lobe


@dataclass(frozen=True, kw_only=True)
class Phong(GlossyOverLambert):
    """Modified Phong: kd / pi + ks (n + 2) / 2pi max(0, cos to the mirror direction)^n.

    Its albedo is kd + ks at normal incidence, where the whole lobe is above the horizon, and less elsewhere.

    Notes
    -----
    [Lafortune1994] Eq. 5, 6.
    """

    model: ClassVar[str] = "phong"
    n: Annotated[float, Range(0.0, 1e6)]
    ks: Annotated[Color, Range(0.0, 1.0)]
    kd: Annotated[Color, Range(0.0, 1.0)] = 0.0

    def glossy(self, geometry: Geometry) -> Array:
        """See `GlossyOverLambert`."""
        mirror_dot_l = 2.0 * geometry.n_dot_l * geometry.n_dot_v - geometry.l_dot_v
        return np.asarray(self.ks) * cosine_lobe(mirror_dot_l, self.n)
