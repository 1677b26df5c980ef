"""The window that interpolates between grid points, and its error."""

import functools
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...conventions import Array

WIDEST = 16
"""Width of the widest kernel: its leakage at low frequencies is rounding alone."""

_NARROWEST = 4
_STOP_BAND = 1.7
_POSITIONS = 64


@dataclass(frozen=True)
class Kernel:
    """The "exponential of semicircle" window of [Barnett2019], on `width` neighbouring grid points.

    Attributes
    ----------
    width : int
        Number of grid points, in each direction, that make an interpolated value.
    """

    width: int

    @property
    def _beta(self) -> float:
        # Frequencies from 1.7 times the grid's own limit upwards leak by exp(-beta) only; beyond a lobe's
        # tail, those between have little to leak (docs/prefiltering.md, section 5).
        return 0.5 * np.pi * _STOP_BAND * self.width

    def __call__(self, distance: Array) -> Array:
        """The window, at distances in grid steps, any shape, of at most width / 2."""
        root = np.sqrt(np.maximum(1.0 - (2.0 / self.width * distance) ** 2, 0.0))
        window: Array = np.exp(self._beta * (root - 1.0))
        return window

    def transform(self, frequency: Array) -> Array:
        """Fourier transform of the window.

        Parameters
        ----------
        frequency : ndarray, any shape
            Radians per grid step.

        Returns
        -------
        ndarray, shape of `frequency`
        """
        # distance = width / 2 sin(a) takes the root out of the end points.
        nodes, weights = _quadrature(8 * self.width + 16)
        a = 0.5 * np.pi * nodes
        distance = 0.5 * self.width * np.sin(a)
        weight = 0.25 * np.pi * self.width * np.cos(a) * weights * self(distance)
        transformed: Array = np.cos(np.multiply.outer(frequency, distance)) @ weight
        return transformed

    def leakage(self, frequency: Array) -> Array:
        """Error of an interpolated wave of unit amplitude.

        Parameters
        ----------
        frequency : ndarray, shape (n,)
            Radians per grid step, ascending from 0 to at most pi.

        Returns
        -------
        ndarray, shape (n,)
            Largest error up to each frequency, of interpolation along one direction: equation 13.
        """
        # Grid points are at 0, 1, ..., so their windows all reach the last step of width / 2.
        position = np.linspace(0.5 * self.width - 1.0, 0.5 * self.width, _POSITIONS)
        taps = np.arange(self.width)
        weights = self(position - taps[:, None])
        sums = np.exp(1j * np.multiply.outer(frequency, taps)) @ weights
        error = sums / self.transform(frequency)[:, None] - np.exp(
            1j * np.multiply.outer(frequency, position)
        )
        largest: Array = np.maximum.accumulate(np.abs(error).max(axis=1))
        return largest


@functools.cache
def _quadrature(nodes: int) -> tuple[Array, Array]:
    return np.polynomial.legendre.leggauss(nodes)


def kernels_for(tolerance: float) -> Iterator[Kernel]:
    """Candidate windows, ascending: from the narrowest that leaks less than `tolerance` of long waves."""
    # At low frequencies a window leaks less than 8 exp(-beta).
    narrowest = int(np.ceil(np.log(8.0 / tolerance) / (0.5 * np.pi * _STOP_BAND)))
    for width in range(min(max(narrowest, _NARROWEST), WIDEST), WIDEST + 1):
        yield Kernel(width)
