"""The model of He, Torrance, Sillion and Greenberg: waves off a rough surface."""

import math
from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np

from ..conventions import Array, ArrayLike
from .fresnel import Fresnel
from .lambert import GlossyOverLambert
from .model import Geometry
from .parameters import Color, Range

NEGLIGIBLE = 1e-16
"""Size of a term, relative to the sum so far, at which the series ends: below float64's rounding."""


@dataclass(frozen=True, kw_only=True)
class HeTorrance(GlossyOverLambert):
    """Light scattered by a Gaussian rough surface, at one wavelength for each channel.

    The directional-diffuse part, unpolarised, plus the uniform-diffuse part kd / pi. The third part, a mirror
    image dimmed by the roughness, is a delta and no function: `mirror_reflectance` gives its weight, which
    vanishes where sigma is no small fraction of the wavelength.

    Attributes
    ----------
    sigma : float
        Root-mean-square height of the surface [um].
    tau : float
        Its autocorrelation length [um].
    wavelength : three floats
        Wavelengths of red, green and blue [um].

    Notes
    -----
    [He1991], its appendix for unpolarised light. Eq. 25 lacks a factor exp(-x^2), x = tau cot / 2 sigma,
    without which Smith's shadowing is no probability; later programs have this factor, and so does this one.
    The factor G of Eq. 76 is (v.v / v_z)^2: its fraction is 1, since s, p and k are an orthonormal frame.
    """

    model: ClassVar[str] = "he_torrance"
    sigma: Annotated[float, Range(0.0, 1.0, low_open=True)]
    tau: Annotated[float, Range(0.0, 100.0, low_open=True)]
    fresnel: Fresnel
    wavelength: Annotated[Color, Range(0.3, 1.0)] = (0.65, 0.55, 0.45)
    kd: Annotated[Color, Range(0.0, 1.0)] = 0.0

    def glossy(self, geometry: Geometry) -> Array:
        """See `GlossyOverLambert`."""
        cosine_sum = geometry.n_dot_l + geometry.n_dot_v
        shadowing = self._shadowing(geometry.n_dot_l) * self._shadowing(geometry.n_dot_v)
        geometric = (2.0 * (1.0 + geometry.l_dot_v) / cosine_sum) ** 2
        scale = shadowing * geometric / (np.pi * geometry.n_dot_l * geometry.n_dot_v)
        across = geometry.light_dir[:, :2] + geometry.view_dir[:, :2]
        wave_number = 2.0 * np.pi / np.asarray(self.wavelength)
        v_xy = wave_number * np.linalg.norm(across, axis=1, keepdims=True)
        series = _series(
            self._phase_variance(geometry.n_dot_l, geometry.n_dot_v), (v_xy * self.tau / 2.0) ** 2
        )
        distribution = (wave_number * self.tau) ** 2 / 16.0 * series
        return scale[:, None] * self.fresnel(geometry.h_dot_l) * distribution

    def mirror_reflectance(self, n_dot_v: ArrayLike) -> Array:
        """Weight of the mirror image, which `__call__` cannot show.

        Parameters
        ----------
        n_dot_v : array_like, shape (N,)
            In (0, 1].

        Returns
        -------
        ndarray, shape (N, 3)
            Share of the light that is reflected as by a smooth mirror, in [0, 1]: [He1991] Eq. 72.
        """
        cosine = np.asarray(n_dot_v, dtype=np.float64)
        dimmed = self._shadowing(cosine)[:, None] ** 2 * np.exp(-self._phase_variance(cosine, cosine))
        reflectance: Array = self.fresnel(cosine) * dimmed
        return reflectance

    def _phase_variance(self, n_dot_l: Array, n_dot_v: Array) -> Array:
        """Variance g of the phase over the heights that are lit and seen, shape (N, 3): Eq. 79."""
        hidden = self._hidden(n_dot_l) + self._hidden(n_dot_v)
        # Eq. 81 with x = z0 / sigma, sqrt(pi / 2) x = hidden / 4 exp(-x^2 / 2), squared: x^2 exp(x^2) = ...
        apparent = self.sigma / np.sqrt(1.0 + _lambert_w(hidden**2 / (8.0 * np.pi)))
        wave_number = 2.0 * np.pi / np.asarray(self.wavelength)
        g: Array = (wave_number * (apparent * (n_dot_l + n_dot_v))[:, None]) ** 2
        return g

    def _slope_ratio(self, cosine: Array) -> Array:
        """Steepness of a direction over that of the surface's slopes, tau cot / 2 sigma; 1e6 is vertical."""
        sine = np.sqrt(np.maximum(1.0 - cosine**2, 0.0))
        steepest = 1e6
        ratio: Array = self.tau * cosine / np.maximum(2.0 * self.sigma * sine, self.tau * cosine / steepest)
        return ratio

    def _hidden(self, cosine: Array) -> Array:
        """Degree to which low parts of the surface are hidden, K of Eq. 82, 83."""
        sine = np.sqrt(np.maximum(1.0 - cosine**2, 0.0))
        hidden: Array = sine / cosine * _erfc(self._slope_ratio(cosine))
        return hidden

    def _shadowing(self, cosine: Array) -> Array:
        """Smith's probability of being seen, Eq. 24, 25 with the exponential."""
        x = self._slope_ratio(cosine)
        beyond = _erfc(x) / 2.0
        excess = np.exp(-(x**2)) / (2.0 * np.sqrt(np.pi) * x) - beyond
        seen: Array = (1.0 - beyond) / (1.0 + excess)
        return seen


_erfc = np.vectorize(math.erfc, otypes=[np.float64])


def _series(g: Array, c: Array) -> Array:
    """Sum over m of g^m exp(-g) / (m! m) exp(-c / m), Eq. 78, to the last digit; 0 if far below 1e-100."""
    total = np.zeros(np.broadcast_shapes(g.shape, c.shape))
    log_g, log_poisson, m = np.log(g), -g, 0
    while True:
        m += 1
        log_poisson = log_poisson + log_g - math.log(m)
        term = np.exp(log_poisson - c / m) / m
        total += term
        if m > np.max(g, initial=0.0) and np.all(term <= NEGLIGIBLE * total):
            return total


def _lambert_w(z: Array) -> Array:
    """The w >= 0 with w exp(w) = z, for z >= 0, by Newton's method from above [Corless1996]."""
    w = np.log1p(z)
    for _ in range(12):
        w = w - (w - z * np.exp(-w)) / (1.0 + w)
    return w
