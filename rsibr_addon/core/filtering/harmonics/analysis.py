"""From a latitude-longitude map to its spherical harmonics: exactly the sums over its texels."""

import numpy as np

from ...conventions import Array
from ...errors import RangeError, ShapeError
from ...maps import equirect
from .coefficients import Complex, EnvironmentHarmonics
from .legendre import MAX_DEGREE, legendre_panels
from .rings import Texels, fast_even, longitude_weights, moment_matching_rings, ring_colatitudes

_ROWS_AT_ONCE = 64
_PAIRS_AT_ONCE = 16


def analyse_environment(radiance: Array, degree: int, texels: Texels = "points") -> EnvironmentHarmonics:
    """Spherical harmonic coefficients of a latitude-longitude map.

    Parameters
    ----------
    radiance : ndarray, shape (height, width, channels)
        Finite; row 0 at the bottom, as everywhere.
    degree : int
        Largest degree wanted, 0 ... `MAX_DEGREE`; it need not fit the map.
    texels : {"points", "areas"}
        "points": the sum over texel centres, weighted with the texels' solid angles, which is what
        brute force computes. "areas": the integral over texels of constant radiance.

    Raises
    ------
    ShapeError
        The map is not a stack of channels.
    RangeError
        The degree is out of range, or the map holds NaN or infinite values.

    Notes
    -----
    Fourier transforms along longitude (equation 5) and colatitude (7, 8) reduce the map to degree + 1 rings
    without loss; then one matrix product per order remains (9).
    """
    if radiance.ndim != 3 or 0 in radiance.shape:
        raise ShapeError(f"A map has rows, columns and channels, but this one has shape {radiance.shape}.")
    if not 0 <= degree <= MAX_DEGREE:
        raise RangeError(f"Degree {degree} cannot be analysed: choose 0 to {MAX_DEGREE}.")
    weights, flux = _ring_weights(radiance, degree, texels)
    return EnvironmentHarmonics(_project(weights, degree), flux, len(radiance))


def _ring_weights(radiance: Array, degree: int, texels: Texels) -> tuple[Complex, Array]:
    """Weights of a few rings that replace the map, and its flux.

    Returns
    -------
    weights : ndarray, shape (orders, channels, rings), complex128
        An even number of orders; the last may be one more than `degree`.
    flux : ndarray, shape (channels,)
    """
    spectra, flux = _row_spectra(radiance, degree)
    if not np.all(np.isfinite(flux)):
        raise RangeError("The map holds NaN or infinite values: repair it in an image editor.")
    rings = fast_even(degree + 1)
    weights = np.empty((*spectra.shape[:3], rings), dtype=np.complex128)
    for start in range(0, len(spectra), _PAIRS_AT_ONCE):
        part = slice(start, start + _PAIRS_AT_ONCE)
        weights[part] = moment_matching_rings(spectra[part], degree, rings, texels)
    by_order = weights.reshape(-1, radiance.shape[2], rings)
    by_order *= longitude_weights(np.arange(len(by_order))[:, None, None], radiance.shape[1], texels)
    return by_order, flux


def _row_spectra(radiance: Array, degree: int) -> tuple[Complex, Array]:
    """Sums over each row of radiance times exp(-i m phi), and of |radiance| times solid angle.

    Returns
    -------
    spectra : ndarray, shape (pairs, 2, channels, height), complex128
        North first; orders in pairs, the last of which may be one more than `degree` and is 0.
    flux : ndarray, shape (channels,)
    """
    height, width, channels = radiance.shape
    m = np.arange(degree + 1)
    # Frequencies beyond the map's own fold back: m and m + width are the same on the texels.
    folded = m % width
    mirrored = folded > width // 2
    folded = np.where(mirrored, width - folded, folded)
    # Longitude falls with the column, from phi = pi (1 - 1 / width).
    phase = np.exp(-1j * np.pi * m * (1.0 - 1.0 / width))
    spectra = np.zeros((degree + 1 + (degree + 1) % 2, channels, height), dtype=np.complex128)
    flux = np.zeros(channels)
    bands = equirect.texel_solid_angle(width, height)[::-1, 0]
    for start in range(0, height, _ROWS_AT_ONCE):
        part = slice(start, start + _ROWS_AT_ONCE)
        rows = radiance[::-1][part].transpose(2, 0, 1).astype(np.float64, order="C")
        flux += np.abs(rows).sum(axis=-1) @ bands[part]
        found = np.fft.rfft(rows)[..., folded]
        np.conjugate(found, out=found, where=~mirrored)
        found *= phase
        spectra[: degree + 1, :, part] = found.transpose(2, 0, 1)
    return spectra.reshape(-1, 2, channels, height), flux


def _project(weights: Complex, degree: int) -> tuple[Complex, ...]:
    """Sum over rings of weight times lambda_lm, for every order: equation 9.

    Degrees with l - m even are symmetric about the equator, the others antisymmetric: the northern
    rings suffice for both.
    """
    channels, rings = weights.shape[1:]
    half = rings // 2
    by_order = [np.empty((degree + 1 - m, channels), dtype=np.complex128) for m in range(degree + 1)]
    theta = ring_colatitudes(rings)[:half]
    for panel in legendre_panels(degree, np.cos(theta), np.sin(theta)):
        rows, orders, _ = panel.values.shape
        first = panel.first_order
        if panel.first_row == 0:
            block = np.ascontiguousarray(weights[first : first + orders].swapaxes(1, 2))
            north, south = block[:, :half], block[:, : half - 1 : -1]
            halves = (north + south).view(np.float64), (north - south).view(np.float64)
        values = panel.values.swapaxes(0, 1)
        sums = np.empty((orders, rows, 2 * channels))
        for parity, ring_weights in enumerate(halves):
            np.matmul(values[:, parity::2], ring_weights[:, panel.first_point :], out=sums[:, parity::2])
        sums *= panel.factors.T[:, :, None]
        for a, found in zip(by_order[first : first + orders], sums.view(np.complex128), strict=False):
            a[panel.first_row : panel.first_row + rows] = found[: max(len(a) - panel.first_row, 0)]
    return tuple(by_order)
