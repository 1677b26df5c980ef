"""Profiles as in [Kautz2000]: samples over the angle from an axis, linear in between."""

from dataclasses import dataclass

import numpy as np

from ..conventions import Array
from ..geometry.directions import camera_frame, dot
from .bank import KernelBank

_SINGULAR = 1e-7
_NARROWEST = 2.0  # kappa * angle^2: the kernel is e^-1 of its peak there


@dataclass(frozen=True)
class RadialProfile:
    """One radially symmetric lobe.

    Attributes
    ----------
    axis : ndarray, shape (3,)
        Unit vector.
    angles : ndarray, shape (N,)
        Ascending from 0 to pi [rad].
    values : ndarray, shape (N, 3)
        [1/sr] in linear Rec. 709.
    """

    axis: Array
    angles: Array
    values: Array

    def __call__(self, directions: Array) -> Array:
        """Values in some directions, shape (..., 3) like theirs."""
        chord = directions - self.axis
        angle = 2.0 * np.arcsin(np.minimum(0.5 * np.sqrt(dot(chord, chord)), 1.0))
        return np.stack([np.interp(angle, self.angles, values) for values in self.values.T], axis=-1)

    @property
    def integral(self) -> Array:
        """Integral over the sphere, shape (3,)."""
        rings = 2.0 * np.pi * np.sin(self.angles)[:, None] * self.values
        integral: Array = 0.5 * np.diff(self.angles) @ (rings[1:] + rings[:-1])
        return integral

    def weights(self, bank: KernelBank) -> Array:
        """The kernels' weights that come nearest, with the same integral.

        Returns
        -------
        ndarray, shape (K, 3)
            Least squares over solid angle; kernels that the rings cannot tell apart share their weight, and
            those that end within the innermost ring have none.
        """
        cells = np.gradient(self.angles) * np.sin(self.angles)
        root = np.sqrt(cells)[:, None]
        kernels = bank.values(np.sin(0.5 * self.angles) ** 2)
        norm: Array = np.sqrt(np.sum((root * kernels) ** 2, axis=0))
        seen = bank.kappa * self.angles[1] ** 2 <= _NARROWEST
        weights = np.zeros((len(bank), 3))
        found = np.linalg.lstsq((root * kernels / norm)[:, seen], root * self.values, rcond=_SINGULAR)[0]
        weights[seen] = found / norm[seen, None]
        got, wanted = weights.sum(axis=0), self.integral
        result: Array = weights * np.divide(wanted, got, out=np.ones(3), where=got * wanted > 0.0)
        return result


def around(axis: Array, angles: Array, planes: int) -> Array:
    """Directions on planes through an axis: each plane has a half on either side of it.

    Parameters
    ----------
    axis : ndarray, shape (3,)
        Unit vector.
    angles : ndarray, shape (N,)
        From the axis [rad].
    planes : int

    Returns
    -------
    ndarray, shape (N, 2 * planes, 3)
        Unit vectors.
    """
    frame = camera_frame(axis)
    psi = np.arange(2 * planes)[:, None] * np.pi / planes
    aside = np.cos(psi) * frame[:, 0] + np.sin(psi) * frame[:, 1]
    directions: Array = np.cos(angles)[:, None, None] * axis + np.sin(angles)[:, None, None] * aside
    return directions
