"""What bilinear lookups in maps of filtered light are expected to cost."""

import numpy as np

from ..conventions import Array
from ..maps.representation import Representation
from .harmonics.coefficients import EnvironmentHarmonics
from .zonal import ZonalSeries


def power_by_degree(harmonics: EnvironmentHarmonics, degree: int) -> Array:
    """Power of every degree of an environment, shape (degree + 1, 3)."""
    power: Array = harmonics.ceilings()[: degree + 1] ** 2 / (2 * np.arange(degree + 1)[:, None] + 1)
    return power


def laplacian(degree: int) -> Array:
    """Factors l (l + 1) by which the Laplacian multiplies the degrees of a map, shape (degree + 1, 1)."""
    l = np.arange(degree + 1.0)[:, None]
    return l * (l + 1.0)


def curvature(kernel: ZonalSeries, harmonics: EnvironmentHarmonics) -> float:
    """Root mean square of the Laplacian of a filtered environment over that of the filtered one itself."""
    power = kernel.coefficients[:, None] ** 2 * power_by_degree(harmonics, kernel.degree)
    return root_of_share(np.sum(power * laplacian(kernel.degree) ** 2), np.sum(power))


def root_of_share(power: np.floating, whole: np.floating) -> float:
    """Root of a power over the whole; 0 in the dark, where nothing can err."""
    return float(np.sqrt(power / whole)) if whole > 0.0 else 0.0


def interpolation_error(curvature: float, layout: Representation, size: int) -> float:
    """Relative root-mean-square error of bilinear lookups.

    Parameters
    ----------
    curvature : float
        Root mean square of the map's Laplacian over that of the map.
    layout : Representation
    size : int
        Width of a sheet in texels.

    Notes
    -----
    Between texels h apart, at a fraction t, a linear lookup errs by h^2 t (1 - t) / 2 times the second
    derivative. Means over t along both axes, for maps that favour no direction, make h^4 times
    (1/40 + 1/144) / 4 of the Laplacian's mean square; and h^2 is a texel's solid angle.
    """
    solid_angle = layout.texel_solid_angle(size)
    texel4 = np.sum(solid_angle**3) / np.sum(solid_angle)
    return float(curvature * np.sqrt((1.0 / 40.0 + 1.0 / 144.0) / 4.0 * texel4))
