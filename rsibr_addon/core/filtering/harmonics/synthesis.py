"""From spherical harmonics back to values, in any directions."""

import ducc0
import numpy as np

from ...conventions import Array
from ...threads import starting, thread_count
from .coefficients import Complex, EnvironmentHarmonics, order_start

INTERPOLATION = 1e-10
"""Largest error of a value, relative to the sum of the largest values that its degrees allow: ducc0 is asked
for a hundredth of it in the root mean square."""


def synthesise(harmonics: EnvironmentHarmonics, gains: Array, theta: Array, phi: Array) -> Array:
    """Sum of gain times coefficient times harmonic, in many directions.

    Parameters
    ----------
    harmonics : EnvironmentHarmonics
    gains : ndarray, shape (degree + 1,)
        Factor of every degree; no more degrees than `harmonics` has.
    theta, phi : ndarray, shape (points,)
        Colatitude in [0, pi] and longitude in [0, 2 pi).

    Returns
    -------
    ndarray, shape (channels, points), float64

    Notes
    -----
    Equation 5. The mean is added apart, so that it has no interpolation error.
    """
    degree = len(gains) - 1
    made = np.zeros((len(harmonics.flux), len(theta)))
    if not len(theta):
        return made
    varying = np.concatenate([[0.0], gains[1:]])
    where = np.stack([theta, phi], axis=-1)
    for channel, values in enumerate(made):  # one after the other, to limit memory
        with starting():
            ducc0.sht.synthesis_general(
                alm=_amplified(harmonics, channel, varying)[None],
                spin=0,
                lmax=degree,
                loc=where,
                epsilon=0.01 * INTERPOLATION,
                nthreads=thread_count(),
                map=values[None],
            )
    mean = gains[0] * harmonics.order(0)[:, 0].real * np.sqrt(0.25 / np.pi)
    made += mean[:, None]
    return made


def _amplified(harmonics: EnvironmentHarmonics, channel: int, gains: Array) -> Complex:
    """A channel's coefficients times the gain of their degree, as many degrees as there are gains."""
    degree = len(gains) - 1
    made = np.empty((degree + 1) * (degree + 2) // 2, dtype=np.complex128)
    for m in range(degree + 1):
        start, count = order_start(m, degree), degree + 1 - m
        np.multiply(harmonics.order(m)[channel, :count], gains[m:], out=made[start : start + count])
    return made
