"""Fresnel reflectance: the share of unpolarised light that a smooth boundary reflects."""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Annotated

import numpy as np

from ..conventions import Array, ArrayLike
from .parameters import Checked, Color, Range


def fresnel_schlick(cosine: ArrayLike, f0: ArrayLike, f90: ArrayLike = 1.0) -> Array:
    """Schlick's approximation.

    Parameters
    ----------
    cosine : array_like, shape (...,)
        Cosine between the light and the boundary's normal, in [0, 1].
    f0, f90 : array_like, broadcastable to `cosine`
        Reflectance at normal and at grazing incidence, in [0, 1].

    Returns
    -------
    ndarray, shape (...,)
        Reflectance in [0, 1].

    Notes
    -----
    [Schlick1994] Eq. 15, with f90 in place of its 1.
    """
    f0 = np.asarray(f0, dtype=np.float64)
    mixed: Array = f0 + (np.asarray(f90) - f0) * (1.0 - np.asarray(cosine)) ** 5
    return mixed


def fresnel_conductor(cosine: ArrayLike, eta: ArrayLike, k: ArrayLike) -> Array:
    """Fresnel's equations for light in air.

    Parameters
    ----------
    cosine : array_like, shape (...,)
        Cosine between the light and the boundary's normal, in [0, 1].
    eta, k : array_like, broadcastable to `cosine`
        Real part, greater than 0, and imaginary part, at least 0, of the index of refraction; a dielectric
        has k = 0.

    Returns
    -------
    ndarray, shape (...,)
        Mean of the reflectances of both polarisations, in [0, 1].

    Notes
    -----
    [Born1999] section 14.2, with the refracted wave's normal component a + ib written out:
    2 a^2 = |n^2 - sin^2| + eta^2 - k^2 - sin^2. Total reflection (k = 0, eta < 1) needs no special case.
    """
    cosine, eta, k = (np.asarray(array, dtype=np.float64) for array in (cosine, eta, k))
    sine2 = 1.0 - cosine**2
    real = eta**2 - k**2 - sine2
    modulus = np.hypot(real, 2.0 * eta * k)  # a^2 + b^2
    twice_a = np.sqrt(2.0 * np.maximum(modulus + real, 0.0))
    even, odd = modulus + cosine**2, twice_a * cosine
    perpendicular = (even - odd) / (even + odd)
    even, odd = modulus * cosine**2 + sine2**2, twice_a * cosine * sine2
    parallel = perpendicular * (even - odd) / (even + odd)
    reflectance: Array = (perpendicular + parallel) / 2.0
    return reflectance


class Fresnel(Checked, ABC):
    """A boundary's reflectance as a function of the angle."""

    @abstractmethod
    def __call__(self, cosine: Array) -> Array:
        """Reflectance, shape (N, 3), at cosines, shape (N,), in [0, 1]."""


@dataclass(frozen=True, kw_only=True)
class Schlick(Fresnel):
    """Schlick's approximation from the reflectances at normal and grazing incidence."""

    f0: Annotated[Color, Range(0.0, 1.0)]
    f90: Annotated[Color, Range(0.0, 1.0)] = 1.0

    def __call__(self, cosine: Array) -> Array:
        """See `fresnel_schlick`."""
        return fresnel_schlick(cosine[:, None], self.f0, self.f90)


@dataclass(frozen=True, kw_only=True)
class Index(Fresnel):
    """Fresnel's equations from an index of refraction; k = 0 is a dielectric."""

    eta: Annotated[Color, Range(0.0, 20.0, low_open=True)]
    k: Annotated[Color, Range(0.0, 40.0)] = 0.0

    def __call__(self, cosine: Array) -> Array:
        """See `fresnel_conductor`."""
        return fresnel_conductor(cosine[:, None], self.eta, self.k)
