"""What bilinear lookups in maps of filtered light are expected to cost."""

import numpy as np

from ..conventions import Array
from ..geometry.directions import dot
from ..maps.representation import Representation
from ..resample import texels_around
from .harmonics.coefficients import EnvironmentHarmonics
from .zonal import ZonalSeries

_POINTS = 2**13
"""Directions over which lookups are averaged: their mean error changes by a percent with more."""


def light_power(harmonics: EnvironmentHarmonics, degree: int) -> Array:
    """Power of every degree of an environment, shape (degree + 1, 3)."""
    power: Array = harmonics.ceilings()[: degree + 1] ** 2 / (2 * np.arange(degree + 1)[:, None] + 1)
    return power


def filtered_power(lobe: ZonalSeries, harmonics: EnvironmentHarmonics) -> Array:
    """Power of every degree of a filtered environment, shape (degree + 1, 3)."""
    power: Array = lobe.coefficients[:, None] ** 2 * light_power(harmonics, lobe.degree)
    return power


class BilinearLookups:
    """Bilinear lookups in maps of one layout and size.

    Parameters
    ----------
    layout : Representation
    size : int
        Width of a sheet in texels.

    Notes
    -----
    Near a direction a map is a gradient and a Hessian on the tangent plane. With the offsets x of the four
    texels there, and their weights w, a lookup errs by g . sum(w x) + H : sum(w x x) / 2. The first is not 0
    where texels are skewed or lie on both sides of a fold. For light that favours no direction, the mean
    square of g . a is |a|^2 / 2 of the gradient's, that of H : M is ((tr M)^2 + 2 M : M) / 8 of the
    Laplacian's.
    """

    def __init__(self, layout: Representation, size: int) -> None:
        direction = _spiral(_POINTS)
        height = layout.shape(size)[1]
        columns, rows, sheets, weights = texels_around(direction, layout, size, height)
        uv = np.stack([(columns + 0.5) / size, (rows + 0.5) / height], axis=-1)
        offset = layout.direction_from_uv(uv, sheets)
        offset -= dot(offset, direction)[..., None] * direction
        first = np.einsum("kn,kni->ni", weights, offset)
        second = 0.5 * np.einsum("kn,kni,knj->nij", weights, offset, offset)
        trace = np.trace(second, axis1=1, axis2=2)
        self._by_gradient = float(np.mean(dot(first, first))) / 2.0
        self._by_laplacian = float(np.mean(trace**2 + 2.0 * np.sum(second**2, axis=(1, 2)))) / 8.0

    def error(self, power: Array, whole: float | None = None) -> float:
        """Their relative root-mean-square error.

        Parameters
        ----------
        power : ndarray, shape (degree + 1, 3)
            Power of every degree of what is looked up.
        whole : float, optional
            Power of what the error is relative to, where that is not what is looked up.

        Returns
        -------
        float
            0 in the dark, where nothing can err.
        """
        l = np.arange(len(power), dtype=np.float64)[:, None]
        laplacian = l * (l + 1.0)
        missed = np.sum(power * laplacian * (self._by_gradient + self._by_laplacian * laplacian))
        whole = float(np.sum(power)) if whole is None else whole
        return float(np.sqrt(missed / whole)) if whole > 0.0 else 0.0


def _spiral(count: int) -> Array:
    """Directions that are spread evenly over the sphere, shape (count, 3)."""
    step = np.arange(count) + 0.5
    z = 1.0 - 2.0 * step / count
    azimuth, radius = np.pi * (1.0 + np.sqrt(5.0)) * step, np.sqrt(1.0 - z**2)
    return np.stack([radius * np.cos(azimuth), radius * np.sin(azimuth), z], axis=-1)
