"""Microfacets with the Trowbridge-Reitz (GGX) distribution and Smith's shadowing."""

from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np

from ..conventions import Array, ArrayLike
from .fresnel import Fresnel
from .model import Brdf, Geometry
from .parameters import Range


def ggx_ndf(half_sine_squared: ArrayLike, alpha: float | Array) -> Array:
    """Trowbridge-Reitz (GGX) density of microfacet normals.

    Parameters
    ----------
    half_sine_squared : array_like, shape (...,)
        1 - (n.h)^2 in [0, 1]; it keeps the digits that n.h loses near 1.
    alpha : float or ndarray, shape (...,)
        Width, roughness**2, in (0, 1].

    Returns
    -------
    ndarray, shape (...,)
        Density [1/sr]; times the cosine n.h it integrates to 1 over the hemisphere.

    Notes
    -----
    [Walter2007] Eq. 33.
    """
    sine2 = np.asarray(half_sine_squared, dtype=np.float64)
    density: Array = alpha**2 / (np.pi * (alpha**2 * (1.0 - sine2) + sine2) ** 2)
    return density


def smith_visibility(n_dot_l: Array, n_dot_v: Array, alpha: float | Array) -> Array:
    """Smith's shadowing and masking of GGX, correlated in height, over 4 n.l n.v.

    Parameters
    ----------
    n_dot_l, n_dot_v : ndarray, shape (...,)
        In (0, 1].
    alpha : float or ndarray, shape (...,)
        Width, roughness**2, in (0, 1].

    Returns
    -------
    ndarray, shape (...,)
        G2 / (4 n.l n.v).

    Notes
    -----
    [Heitz2014] Eq. 99 with the Lambda of Eq. 72; the fraction is reduced so that nothing cancels at grazing.
    """
    light_part = n_dot_l * np.sqrt(alpha**2 + (1.0 - alpha**2) * n_dot_v**2)
    view_part = n_dot_v * np.sqrt(alpha**2 + (1.0 - alpha**2) * n_dot_l**2)
    visibility: Array = 0.5 / (light_part + view_part)
    return visibility


@dataclass(frozen=True, kw_only=True)
class Ggx(Brdf):
    """Rough metal or dielectric: one reflection off GGX microfacets.

    Light that bounces between facets is left out, so that the albedo of a rough perfect mirror falls below 1:
    at normal incidence to 0.88 for alpha = 0.3, to 0.31 for alpha = 1.

    Notes
    -----
    [Walter2007] Eq. 20 with the shadowing of [Heitz2014].
    """

    model: ClassVar[str] = "ggx"
    alpha: Annotated[float, Range(0.0, 1.0, low_open=True)]
    fresnel: Fresnel

    def above_horizon(self, geometry: Geometry) -> Array:
        """See `Brdf`."""
        facets = ggx_ndf(geometry.half_sine_squared, self.alpha)
        facets = facets * smith_visibility(geometry.n_dot_l, geometry.n_dot_v, self.alpha)
        return facets[:, None] * self.fresnel(geometry.h_dot_l)
