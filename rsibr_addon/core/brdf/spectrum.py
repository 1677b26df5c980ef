"""Linear Rec. 709 from spectra."""

import numpy as np

from ..conventions import Array, ArrayLike
from ..errors import RangeError

REC709_FROM_XYZ = np.array(
    [
        [3.14665765, -1.66646375, -0.48019390],
        [-0.99552161, 1.95575673, 0.03976487],
        [0.06359480, -0.21456322, 1.15096842],
    ]
)
"""Linear Rec. 709 from CIE XYZ of which (1, 1, 1) is white, adapted to D65 [Lam1985]: rows sum to 1."""

LOBES = (
    ((1.056, 599.8, 0.0264, 0.0323), (0.362, 442.0, 0.0624, 0.0374), (-0.065, 501.1, 0.0490, 0.0382)),
    ((0.821, 568.8, 0.0213, 0.0247), (0.286, 530.9, 0.0613, 0.0322)),
    ((1.217, 437.0, 0.0845, 0.0278), (0.681, 459.0, 0.0385, 0.0725)),
)
"""Of x, y and z: height, centre [nm], and inverse widths [1/nm] below and above the centre."""

STEP = 1.0
"""[nm] between the points at which spectra are integrated."""


def color_matching(wavelength: ArrayLike) -> Array:
    """The CIE 1931 colour-matching functions of the 2-degree observer.

    Parameters
    ----------
    wavelength : array_like, shape (...,)
        [nm].

    Returns
    -------
    ndarray, shape (..., 3), float64
        x, y and z, in [0, 1.8].

    Notes
    -----
    [Wyman2013] section 2.2, a sum of Gaussians within 1 % of the tables.
    """
    wavelength = np.asarray(wavelength, dtype=np.float64)
    functions = []
    for lobes in LOBES:
        total = np.zeros_like(wavelength)
        for height, centre, below, above in lobes:
            offset = (wavelength - centre) * np.where(wavelength < centre, below, above)
            total = total + height * np.exp(-(offset**2) / 2.0)
        functions.append(total)
    return np.stack(functions, axis=-1)


def rec709_from_spectrum(wavelength: ArrayLike, spectrum: ArrayLike) -> Array:
    """Colour of a reflectance spectrum under white light.

    Parameters
    ----------
    wavelength : array_like, shape (W,)
        [nm], increasing.
    spectrum : array_like, shape (..., W)
        Reflectance, or a quantity like it, at those wavelengths; linear between them.

    Returns
    -------
    ndarray, shape (..., 3), float64
        Linear Rec. 709: a flat spectrum gives its value in all three. Colours outside the gamut have
        negative parts.

    Raises
    ------
    RangeError
        Fewer than two wavelengths, or they do not increase.

    Notes
    -----
    Integrated against `color_matching` over the wavelengths that are given, as if nothing but them could
    be seen, under a light of equal energy, and adapted to D65.
    """
    wavelength = np.asarray(wavelength, dtype=np.float64)
    if wavelength.size < 2 or not np.all(np.diff(wavelength) > 0.0):
        raise RangeError("A spectrum needs at least two wavelengths, in increasing order.")
    count = max(int(np.ceil((wavelength[-1] - wavelength[0]) / STEP)), 1)
    fine = wavelength[0] + (np.arange(count) + 0.5) / count * (wavelength[-1] - wavelength[0])
    observer = color_matching(fine)
    # Linear interpolation as a matrix, so that many spectra take one product
    hats = np.stack([np.interp(fine, wavelength, row) for row in np.eye(wavelength.size)])
    xyz = np.asarray(spectrum, dtype=np.float64) @ (hats @ (observer / observer.sum(axis=0)))
    rgb: Array = xyz @ REC709_FROM_XYZ.T
    return rgb
