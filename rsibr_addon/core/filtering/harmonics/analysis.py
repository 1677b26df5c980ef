"""From a latitude-longitude map to its spherical harmonics: exactly the sums over its texels."""

import ducc0
import numpy as np

from ...conventions import Array
from ...errors import RangeError, ShapeError
from ...maps import equirect
from ...threads import starting, thread_count
from .coefficients import EnvironmentHarmonics

MAX_DEGREE = 3840
"""Largest degree: its coefficients take 118 MB a channel, and a lobe 0.32 degrees wide needs no more."""


def analyse_environment(radiance: Array, degree: int) -> EnvironmentHarmonics:
    """Spherical harmonic coefficients of a latitude-longitude map.

    Parameters
    ----------
    radiance : ndarray, shape (height, width, channels)
        Finite; row 0 at the bottom, as everywhere.
    degree : int
        Largest degree wanted, 0 ... `MAX_DEGREE`; it need not fit the map.

    Raises
    ------
    ShapeError
        The map is not a stack of channels.
    RangeError
        The degree is out of range, or the map holds NaN or infinite values.

    Notes
    -----
    Equation 4, the sum over texel centres weighted with the texels' solid angles, which is what brute force
    computes: the adjoint of the synthesis of a map.
    """
    if radiance.ndim != 3 or 0 in radiance.shape:
        raise ShapeError(f"A map has rows, columns and channels, but this one has shape {radiance.shape}.")
    if not 0 <= degree <= MAX_DEGREE:
        raise RangeError(f"Degree {degree} cannot be analysed: choose 0 to {MAX_DEGREE}.")
    height, width, channels = radiance.shape
    solid_angle = equirect.texel_solid_angle(width, height)[::-1, :1]
    flux = np.empty(channels)
    coefficients = np.empty((channels, (degree + 1) * (degree + 2) // 2), dtype=np.complex128)
    light = np.empty((height, width))  # of one channel after the other, to limit the memory
    for channel in range(channels):
        # Rows from north to south; longitude, which falls with the column, from -pi (1 - 1 / width) up
        np.multiply(radiance[::-1, ::-1, channel], solid_angle, out=light)
        flux[channel] = sum(np.abs(row).sum() for row in light)
        if not np.isfinite(flux[channel]):
            raise RangeError("The map holds NaN or infinite values: repair it in an image editor.")
        with starting():
            ducc0.sht.adjoint_synthesis_2d(
                map=light[None],
                spin=0,
                lmax=degree,
                geometry="F1",
                phi0=-np.pi * (1.0 - 1.0 / width),
                nthreads=thread_count(),
                alm=coefficients[channel, None],
            )
    return EnvironmentHarmonics(coefficients, flux, degree, height)
