"""An environment in spherical harmonics."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...conventions import Array

type Complex = NDArray[np.complex128]
"""An array of complex numbers of any shape; docstrings say which."""


@dataclass(frozen=True)
class EnvironmentHarmonics:
    """An environment, analysed up to a degree; made by `analysis.analyse_environment`.

    Attributes
    ----------
    by_order : tuple of ndarray, shape (degree + 1 - m, channels), complex128
        Entry m holds a_lm for l = m ... degree: the sum over the texels of radiance times solid angle
        times lambda_lm(theta) exp(-i m phi) (equation 4). Negative orders are the conjugates.
    flux : ndarray, shape (channels,)
        Sum over the texels of |radiance| times solid angle: 4 pi times the mean radiance.
    height : int
        Rows of the map, each pi / height high.
    """

    by_order: tuple[Complex, ...]
    flux: Array
    height: int

    @property
    def degree(self) -> int:
        """The largest degree that is known."""
        return len(self.by_order) - 1

    def power(self) -> Array:
        """Power of every degree: the sum over all orders of |a_lm|^2.

        Returns
        -------
        ndarray, shape (degree + 1, channels)
        """
        power = np.zeros((self.degree + 1, len(self.flux)))
        for m, a in enumerate(self.by_order):
            power[m:] += (1.0 if m == 0 else 2.0) * (a.real**2 + a.imag**2)
        return power

    def ceilings(self) -> Array:
        """The largest value that the power of every degree allows anywhere (equation 14).

        Returns
        -------
        ndarray, shape (degree + 1, channels)
        """
        l = np.arange(self.degree + 1)[:, None]
        ceilings: Array = np.sqrt((2 * l + 1) / (4.0 * np.pi) * self.power())
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
            a = self.by_order[m][: len(l)]
            if m == 0:
                found[l * (l + 1)] = a.real
            else:
                found[l * (l + 1) + m] = np.sqrt(2.0) * a.real
                found[l * (l + 1) - m] = -np.sqrt(2.0) * a.imag
        return found
