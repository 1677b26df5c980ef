"""From spherical harmonics back to values, in any directions: on a grid, and between its points."""

import numpy as np

from ...conventions import Array, Indices
from ...ties import TIE
from .coefficients import Complex, EnvironmentHarmonics
from .kernel import WIDEST, Kernel
from .legendre import Panel, legendre_panels
from .rings import fast_even, ring_colatitudes, ring_resampler

OVERSAMPLING = 1.2
"""Grid rows per degree, at least."""

_RINGS_AT_ONCE = 8
_GATHERED_BYTES = 2**20
_POINTS_AT_ONCE = 2**16


def grid_rows(degree: int) -> int:
    """Rows of the grid on which harmonics up to `degree` are interpolated; it is twice as wide."""
    return fast_even(max(OVERSAMPLING * (degree + 1), WIDEST + 2))


def synthesise(
    harmonics: EnvironmentHarmonics, gains: Array, theta: Array, phi: Array, kernel: Kernel
) -> Array:
    """Sum of gain times coefficient times harmonic, in many directions.

    Parameters
    ----------
    harmonics : EnvironmentHarmonics
    gains : ndarray, shape (slices, degree + 1)
        Factor of every degree, at least two; no more degrees than `harmonics` has.
    theta, phi : ndarray, shape (points,)
        Colatitude in [0, pi] and longitude in [0, 2 pi).
    kernel : Kernel
        Sets the accuracy: see `Kernel.leakage`.

    Returns
    -------
    ndarray, shape (points, slices, channels), float64

    Notes
    -----
    Equation 12. The mean is added apart from the grid, so that it has no interpolation error.
    """
    slices, degree = gains.shape[0], gains.shape[1] - 1
    channels = len(harmonics.flux)
    rows = grid_rows(degree)
    varying = gains.copy()
    varying[:, 0] = 0.0
    grid = _grid(_ring_functions(harmonics, varying, rows, kernel), degree, kernel.width // 2 + 1)
    values = np.empty((len(theta), slices * channels))
    for start in range(0, len(theta), _POINTS_AT_ONCE):
        part = slice(start, start + _POINTS_AT_ONCE)
        _interpolate(grid, theta[part] * (rows / np.pi), phi[part] * (rows / np.pi), kernel, values[part])
    mean = harmonics.by_order[0][0].real * np.sqrt(0.25 / np.pi)
    found: Array = values.reshape(-1, slices, channels)
    found += gains[:, 0, None] * mean
    return found


def synthesise_directly(harmonics: EnvironmentHarmonics, gains: Array, theta: Array, phi: Array) -> Array:
    """The same as `synthesise`, term by term: slow, without a grid and its interpolation.

    Parameters
    ----------
    harmonics, gains, theta, phi
        As for `synthesise`.

    Returns
    -------
    ndarray, shape (points, slices, channels), float64
    """
    degree = gains.shape[1] - 1
    found = np.zeros((len(theta), gains.shape[0], len(harmonics.flux)))
    order = np.argsort(np.sin(theta))
    theta, phi = theta[order], phi[order]
    for panel in legendre_panels(degree, np.cos(theta), np.sin(theta)):
        coefficients = _panel_coefficients(harmonics, gains, panel)
        points = slice(panel.first_point, None)
        for i in range(panel.values.shape[1]):
            m = panel.first_order + i
            wave = (1.0 if m == 0 else 2.0) * np.exp(1j * m * phi[points])
            term = np.tensordot(panel.values[:, i].T * wave[:, None], coefficients[i], axes=1)
            found[order[points]] += term.real
    return found


def _panel_coefficients(harmonics: EnvironmentHarmonics, gains: Array, panel: Panel) -> Complex:
    """Gain * a_lm * factor for a panel, shape (orders, rows, slices, channels), complex128."""
    rows, orders = panel.factors.shape
    degree = gains.shape[1] - 1
    coefficients = np.zeros((orders, rows, len(gains), len(harmonics.flux)), dtype=np.complex128)
    for i in range(orders):
        first = panel.first_order + i + panel.first_row
        count = min(rows, degree + 1 - first)
        if count > 0:
            a = harmonics.by_order[panel.first_order + i][panel.first_row : panel.first_row + count]
            factors = gains[:, first : first + count].T * panel.factors[:count, i, None]
            np.multiply(factors[:, :, None], a[:, None, :], out=coefficients[i, :count])
    return coefficients


def _ring_functions(harmonics: EnvironmentHarmonics, gains: Array, rows: int, kernel: Kernel) -> Complex:
    """Fourier coefficients of the grid's rows, shape (pairs, 2, slices * channels, rows), complex128.

    They are divided by the kernel's transform, in both directions; interpolation undoes this.
    """
    degree = gains.shape[1] - 1
    columns = len(gains) * len(harmonics.flux)
    rings = fast_even(degree + 1)
    half = rings // 2
    theta = ring_colatitudes(rings)[:half]
    orders = degree + 1 + (degree + 1) % 2
    correction = 1.0 / kernel.transform(np.arange(orders) * (np.pi / rows))
    resample = ring_resampler(rings, rows, correction[: degree + 1])
    functions = np.empty((orders // 2, 2, columns, rows), dtype=np.complex128)
    for panel in legendre_panels(degree, np.cos(theta), np.sin(theta)):
        block = panel.values.shape[1]
        if panel.first_row == 0:
            halves = np.zeros((2, block, 2 * columns, half))
        coefficients = _panel_coefficients(harmonics, gains, panel)
        coefficients *= correction[panel.first_order : panel.first_order + block, None, None, None]
        flat = coefficients.reshape(block, -1, columns).view(np.float64).swapaxes(1, 2)
        values = panel.values.swapaxes(0, 1)
        for parity in (0, 1):
            halves[parity, ..., panel.first_point :] += flat[..., parity::2] @ values[:, parity::2]
        if panel.first_row + len(panel.values) + panel.first_order > degree:
            # Pair by pair, to stay within the cache.
            for pair in range(0, block, 2):
                resample(_unfold(halves[:, pair : pair + 2]), functions[(panel.first_order + pair) // 2])
    return functions


def _unfold(halves: Array) -> Complex:
    """All rings from the symmetric and the antisymmetric part over the northern ones.

    Parameters
    ----------
    halves : ndarray, shape (2, 2, 2 * columns, rings / 2)
        Parts of two orders; real and imaginary parts alternate.

    Returns
    -------
    ndarray, shape (2, columns, rings), complex128
    """
    _, _, columns, half = halves.shape
    symmetric, antisymmetric = halves.reshape(2, 2, columns // 2, 2, half)
    rings = np.empty((2, columns // 2, 2 * half), dtype=np.complex128)
    for part, target in enumerate((rings.real, rings.imag)):
        even, odd = symmetric[:, :, part], antisymmetric[:, :, part]
        np.add(even, odd, out=target[..., :half])
        np.subtract(even, odd, out=target[..., : half - 1 : -1])
    return rings


def _grid(functions: Complex, degree: int, border: int) -> Array:
    """Values on the grid, continued beyond its edges as on the sphere.

    Parameters
    ----------
    functions : ndarray, shape (pairs, 2, columns, rows)
    degree : int
    border : int
        Grid points to add on every side.

    Returns
    -------
    ndarray, shape (rows + 2 * border, 2 * rows + 2 * border, columns), float64
        Row `border` is nearest to the north pole; column `border` has longitude 0.
    """
    _, _, columns, rows = functions.shape
    width = 2 * rows
    by_order = functions.reshape(-1, columns, rows)[: degree + 1]
    grid = np.empty((rows + 2 * border, width + 2 * border, columns))
    inner = grid[border:-border, border:-border]
    for start in range(0, rows, _RINGS_AT_ONCE):
        part = slice(start, start + _RINGS_AT_ONCE)
        spectra = np.ascontiguousarray(by_order[..., part].T)
        inner[part] = np.fft.irfft(spectra, width, norm="forward").swapaxes(1, 2)
    across = np.roll(np.arange(width), rows)
    grid[:border, border:-border] = inner[:border, across][::-1]
    grid[-border:, border:-border] = inner[-border:, across][::-1]
    grid[:, :border] = grid[:, width : width + border]
    grid[:, -border:] = grid[:, border : 2 * border]
    return grid


def _interpolate(grid: Array, row: Array, column: Array, kernel: Kernel, values: Array) -> None:
    """Sum grid points weighted with the kernel.

    Parameters
    ----------
    grid : ndarray, shape (rows + 2 * border, 2 * rows + 2 * border, columns)
        As `_grid` makes it.
    row, column : ndarray, shape (points,)
        Colatitude and longitude in grid steps.
    kernel : Kernel
    values : ndarray, shape (points, columns)
        Receives the sums.
    """
    width = kernel.width
    border = width // 2 + 1
    taps = np.arange(width)
    first_row, row_weights = _taps(row - 0.5, kernel)
    first_column, column_weights = _taps(column, kernel)
    corner = (first_row + border) * grid.shape[1] + first_column + border
    neighbours = (taps[:, None] * grid.shape[1] + taps).ravel()
    points = grid.reshape(-1, grid.shape[-1])
    chunk = max(1, _GATHERED_BYTES // (8 * width**2 * grid.shape[-1]))
    gathered = np.empty((chunk, width**2, grid.shape[-1]))
    for start in range(0, len(row), chunk):
        part = slice(start, start + chunk)
        weights = row_weights[part, :, None] * column_weights[part, None, :]
        count = len(weights)
        # The indices are within the grid; mode "clip" only saves a copy.
        np.take(points, corner[part, None] + neighbours, axis=0, out=gathered[:count], mode="clip")
        np.matmul(weights.reshape(count, 1, -1), gathered[:count], out=values[part, None])


def _taps(position: Array, kernel: Kernel) -> tuple[Indices, Array]:
    """First grid point of each window, shape (points,), and its weights, shape (points, width)."""
    first = np.ceil(position - 0.5 * kernel.width - TIE)
    weights = kernel((position - first)[:, None] - np.arange(kernel.width))
    return first.astype(np.intp), weights
