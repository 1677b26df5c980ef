"""Linear Rec. 709 from spectra."""

import numpy as np

from ..conventions import Array, ArrayLike
from ..errors import RangeError
from ..warned import warn

REC709_FROM_XYZ = np.array(
    [
        [3.14665765, -1.66646375, -0.48019390],
        [-0.99552161, 1.95575673, 0.03976487],
        [0.06359480, -0.21456322, 1.15096842],
    ]
)
"""Linear Rec. 709 from CIE XYZ with (1, 1, 1) as white, adapted to D65 [Lam1985]: rows sum to 1."""

LOBES = (
    ((1.056, 599.8, 0.0264, 0.0323), (0.362, 442.0, 0.0624, 0.0374), (-0.065, 501.1, 0.0490, 0.0382)),
    ((0.821, 568.8, 0.0213, 0.0247), (0.286, 530.9, 0.0613, 0.0322)),
    ((1.217, 437.0, 0.0845, 0.0278), (0.681, 459.0, 0.0385, 0.0725)),
)
"""Gaussians of x, y and z: height, centre [nm], and inverse widths [1/nm] below and above the centre."""

STEP = 1.0
"""[nm] Step of the integration of spectra."""

VISIBLE = (360.0, 830.0)
"""[nm] Wavelengths that the standard observer sees."""

UNSEEN = 0.05
"""Share of a colour-matching function beyond a spectrum's ends above which a warning is given; beyond 400 to
700 nm it is 0.005 at most."""


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


def told_wavelengths(wavelength: ArrayLike, name: str) -> Array:
    """The wavelengths of a file in nanometres, with warnings of those that a colour cannot use.

    Parameters
    ----------
    wavelength : array_like, shape (W,)
        As the file has them, increasing.
    name : str
        Named in messages.

    Returns
    -------
    ndarray, shape (W,), float64
        [nm].

    Raises
    ------
    RangeError
        None of them is visible.

    Warns
    -----
    RsibrWarning
        By their size they are micrometres or metres, and are converted; some are not visible; or they leave
        out a part of the visible range.
    """
    wavelength = np.asarray(wavelength, dtype=np.float64)
    for scale, unit in ((1e3, "micrometres"), (1e9, "metres")):
        if wavelength.size and VISIBLE[0] < scale * np.mean(wavelength) < 5.0 * VISIBLE[1]:
            warn(f"The wavelengths of {name} are {_span(wavelength)}, and taken for {unit}.")
            wavelength = scale * wavelength
            break
    seen = (wavelength >= VISIBLE[0]) & (wavelength <= VISIBLE[1])
    if not seen.any():
        raise RangeError(f"its wavelengths, {_span(wavelength)} nm, are not visible.")
    if not seen.all():
        warn(
            f"{np.count_nonzero(~seen)} of the wavelengths of {name}, {_span(wavelength)} nm, are "
            f"not visible: they do not count."
        )
    visible = np.arange(*VISIBLE, STEP)
    white = color_matching(visible)
    told = white[(visible >= wavelength.min()) & (visible <= wavelength.max())]
    if (unseen := float(np.max(1.0 - told.sum(axis=0) / white.sum(axis=0)))) > UNSEEN:
        warn(
            f"The wavelengths of {name}, {_span(wavelength)} nm, leave out up to {100.0 * unseen:.2g} % of "
            f"a colour: only the rest counts."
        )
    return wavelength


def _span(wavelength: Array) -> str:
    return f"{wavelength.min():g} to {wavelength.max():g}"


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
    Integrated with `color_matching` over the given wavelengths, as if no others were visible, under a light
    of equal energy, and adapted to D65.
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
