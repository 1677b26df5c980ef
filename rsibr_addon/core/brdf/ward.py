"""Ward's model, isotropic: a Gaussian of the half vector's slope."""

from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np

from ..conventions import Array
from .lambert import GlossyOverLambert
from .model import Geometry
from .parameters import Color, Range


@dataclass(frozen=True, kw_only=True)
class Ward(GlossyOverLambert):
    """Diffuse kd / pi plus a Gaussian lobe of weight ks and width alpha.

    The lobe is ks exp(-tan^2(h) / alpha^2) / (4 pi alpha^2 sqrt(n.l n.v)). Its albedo comes near to ks for a
    narrow lobe at normal incidence and falls towards grazing.

    Notes
    -----
    [Ward1992] Eq. 4. [Kautz2000] uses kd = 0, ks = 0.8, alpha = 0.04 in its Figures 7 and 15-18.
    """

    model: ClassVar[str] = "ward"
    alpha: Annotated[float, Range(0.0, 1.0, low_open=True)]
    ks: Annotated[Color, Range(0.0, 1.0)]
    kd: Annotated[Color, Range(0.0, 1.0)] = 0.0

    def glossy(self, geometry: Geometry) -> Array:
        """See `GlossyOverLambert`."""
        slope2 = geometry.half_sine_squared / geometry.n_dot_h**2
        lobe = np.exp(-slope2 / self.alpha**2) / np.sqrt(geometry.n_dot_l * geometry.n_dot_v)
        return np.asarray(self.ks) * (lobe / (4.0 * np.pi * self.alpha**2))[:, None]
