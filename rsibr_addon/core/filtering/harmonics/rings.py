"""Functions of the colatitude as periodic functions of it.

Followed beyond a pole, harmonics of order m continue as (-1)^m times themselves, so on the full
circle of 2 pi they are trigonometric polynomials of their degree (equation 6). That makes it exact
to shift them from one set of rings to another. Two neighbouring orders, one even and one odd about
the poles, together are a periodic function without any symmetry: they share one Fourier transform.
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from ...conventions import Array, Indices
from .coefficients import Complex

type Texels = Literal["points", "areas"]
"""The meaning of a texel: all its light at its centre, or constant radiance over its solid angle."""


def fast_even(least: float) -> int:
    """The smallest even number, at least `least`, without prime factors above 5: a quick transform."""
    number = 2 * int(np.ceil(least / 2.0))
    while not _has_small_factors(number):
        number += 2
    return number


def _has_small_factors(number: int) -> bool:
    for factor in (2, 3, 5):
        while number % factor == 0:
            number //= factor
    return number == 1


def ring_colatitudes(count: int) -> Array:
    """Colatitudes (t + 1/2) pi / count of `count` rings, from north to south, shape (count,)."""
    colatitudes: Array = np.pi * (np.arange(count) + 0.5) / count
    return colatitudes


def longitude_weights(orders: Indices, width: int, texels: Texels) -> Array:
    """Integral of exp(-i m phi) over one texel's longitudes, over its value at the texel's centre.

    Parameters
    ----------
    orders : ndarray of int, any shape
        m.
    width : int
        Texels around the horizon.
    texels : {"points", "areas"}

    Returns
    -------
    ndarray, shape of `orders`
    """
    return _sine_weights(orders, np.pi / width, texels)


def _sine_weights(frequencies: Indices, half_cell: float, texels: Texels) -> Array:
    """2 sin(k h) / k, the integral of exp(-i k x) over a cell of half-width h, or 2 h throughout."""
    if texels == "points":
        return np.full(frequencies.shape, 2.0 * half_cell)
    weights: Array = 2.0 * half_cell * np.sinc(frequencies * half_cell / np.pi)
    return weights


def moment_matching_rings(rows: Complex, degree: int, count: int, texels: Texels) -> Complex:
    """A few rings that exactly replace the many rows of a map, for all harmonics up to a degree.

    Parameters
    ----------
    rows : ndarray, shape (pairs, 2, channels, height), complex128
        Fourier coefficients of the map's rows, of an even order and the odd order after it; from
        north to south.
    degree : int
    count : int
        Number of rings to make, more than `degree`.
    texels : {"points", "areas"}
        The meaning of a row's value.

    Returns
    -------
    ndarray, shape (pairs, 2, channels, count), complex128
        Ring weights: with them, the sum over the rings of weight times harmonic is, up to `degree`,
        the sum over the rows of value times harmonic times solid angle (per unit of longitude).

    Notes
    -----
    Equations 7 and 8.
    """
    height = rows.shape[-1]
    # Row j at theta_j and its mirror image beyond the pole, where odd orders change their sign, and so does
    # sin(theta), a factor that follows.
    circle = np.concatenate([rows[:, 0] + rows[:, 1], (rows[:, 1] - rows[:, 0])[..., ::-1]], axis=-1)
    k = np.arange(-degree - 1, degree + 2)
    half_cell = 0.5 * np.pi / height
    centred = np.exp(-1j * k * half_cell) / 2j
    if texels == "points":
        centred *= 2.0 * np.sin(half_cell)
    else:
        centred *= _sine_weights(k, half_cell, texels)
    moments = np.fft.fft(circle)[..., k % (2 * height)] * centred
    moments = moments[..., :-2] - moments[..., 2:]
    spectrum = np.zeros((*moments.shape[:-1], 2 * count), dtype=np.complex128)
    inner = k[1:-1]
    spectrum[..., inner % (2 * count)] = moments * np.exp(0.5j * np.pi * inner / count)
    weights = np.empty((2, *spectrum.shape[:-1], count), dtype=np.complex128)
    spectrum *= 0.5
    _split(np.fft.ifft(spectrum), weights)
    return weights.swapaxes(0, 1)


@dataclass(frozen=True)
class RingResampler:
    """Carries functions of the colatitude over to other rings, with a gain for every frequency.

    Attributes
    ----------
    given, made : int
        Numbers of rings, each above the degree of the functions.
    factors : ndarray, shape (degree + 1,), complex128
        Made by `ring_resampler`.
    """

    given: int
    made: int
    factors: Complex

    def __call__(self, rings: Complex, out: Complex) -> None:
        """Resample an even order and the odd order after it.

        Parameters
        ----------
        rings : ndarray, shape (2, columns, given), complex128
        out : ndarray, shape (2, columns, made), complex128
            Receives the functions on the new rings.
        """
        circle = np.empty((rings.shape[1], 2 * self.given), dtype=np.complex128)
        np.add(rings[0], rings[1], out=circle[:, : self.given])
        np.subtract(rings[0], rings[1], out=circle[:, : self.given - 1 : -1])
        found = np.fft.fft(circle)
        spectrum = np.zeros((rings.shape[1], 2 * self.made), dtype=np.complex128)
        above = len(self.factors)
        np.multiply(found[:, :above], self.factors, out=spectrum[:, :above])
        np.multiply(found[:, 1 - above :], self.factors[:0:-1].conj(), out=spectrum[:, 1 - above :])
        _split(np.fft.ifft(spectrum, norm="forward"), out)


def ring_resampler(given: int, made: int, gains: Array) -> RingResampler:
    """Prepare to carry functions of some degree over from `given` to `made` rings.

    Parameters
    ----------
    given, made : int
        Numbers of rings, each above the degree.
    gains : ndarray, shape (degree + 1,), degree at least 1
        Factor of exp(i k theta) and of exp(-i k theta).
    """
    k = np.arange(len(gains))
    shift: Complex = np.exp(0.5j * np.pi * k * (1.0 / made - 1.0 / given))
    shift *= 0.25 / given * gains
    return RingResampler(given, made, shift)


def _split(circle: Complex, out: Complex) -> None:
    """Twice the even and twice the odd order, from their sum over the circle."""
    count = out.shape[-1]
    near, far = circle[..., :count], circle[..., : count - 1 : -1]
    np.add(near, far, out=out[0])
    np.subtract(near, far, out=out[1])
