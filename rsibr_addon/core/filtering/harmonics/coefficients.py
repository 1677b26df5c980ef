"""An environment in spherical harmonics."""

import functools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...conventions import Array

Complex = NDArray[np.complex128]
"""An array of complex numbers of any shape; docstrings say which."""


@dataclass(frozen=True)
class EnvironmentHarmonics:
    """An environment, analysed up to a degree; made by `analysis.analyse_environment`.

    Attributes
    ----------
    coefficients : ndarray, shape (channels, (degree + 1) (degree + 2) / 2), complex128
        a_lm of the orders m = 0 ... degree in turn, each for l = m ... degree: the sum over the texels of
        radiance times solid angle times (-1)^m lambda_lm(theta) exp(-i m phi) (equation 4). Negative orders
        are (-1)^m times the conjugates.
    flux : ndarray, shape (channels,)
        Sum over the texels of |radiance| times solid angle: 4 pi times the mean radiance.
    degree : int
        The largest degree that is known.
    height : int
        Rows of the map, each pi / height high.
    """

    coefficients: Complex
    flux: Array
    degree: int
    height: int

    def order(self, m: int) -> Complex:
        """The coefficients of one order, shape (channels, degree + 1 - m): a view."""
        start = order_start(m, self.degree)
        return self.coefficients[:, start : start + self.degree + 1 - m]

    @functools.cached_property
    def power(self) -> Array:
        """Power of every degree: the sum over all orders of |a_lm|^2, shape (degree + 1, channels)."""
        power = np.zeros((self.degree + 1, len(self.flux)))
        for m in range(self.degree + 1):
            a = self.order(m).T
            power[m:] += (1.0 if m == 0 else 2.0) * (a.real**2 + a.imag**2)
        return power

    def ceilings(self) -> Array:
        """The largest value that the power of every degree allows anywhere (equation 6).

        Returns
        -------
        ndarray, shape (degree + 1, channels)
        """
        l = np.arange(self.degree + 1)[:, None]
        ceilings: Array = np.sqrt((2 * l + 1) / (4.0 * np.pi) * self.power)
        return ceilings

    def real(self, degree: int) -> Array:
        """Coefficients of the real harmonics, in the order of `irradiance.real_harmonics`.

        Parameters
        ----------
        degree : int
            Largest degree, at most the degree that is known.

        Returns
        -------
        ndarray, shape ((degree + 1)**2, channels)
            Entry l (l + 1) + m, m = -l ... l.
        """
        found = np.empty(((degree + 1) ** 2, len(self.flux)))
        for m in range(degree + 1):
            l = np.arange(m, degree + 1)
            a = self.order(m)[:, : len(l)].T
            if m == 0:
                found[l * (l + 1)] = a.real
            else:
                sign = (-1.0) ** m * np.sqrt(2.0)
                found[l * (l + 1) + m] = sign * a.real
                found[l * (l + 1) - m] = -sign * a.imag
        return found


def order_start(m: int, degree: int) -> int:
    """Where the first coefficient of an order, l = m, stands among all up to a degree."""
    return m * (2 * degree + 3 - m) // 2
