"""Text files with Cornell's measurements of surfaces: spectra at scattered pairs of directions."""

from pathlib import Path

import numpy as np

from ..core.brdf.measured_cornell import Scattered, scattered_brdf
from ..core.brdf.spectrum import rec709_from_spectrum, told_wavelengths
from ..core.conventions import Array
from ..core.errors import InputFileError, RangeError
from ..core.warned import warn
from .reading import opened

LARGEST = 1 << 26
"""Largest file in bytes; the laboratory's have half a million."""

COMMENT = "#"


def read_cornell(path: str | Path) -> Scattered:
    """Read a reflectance measured at Cornell's Program of Computer Graphics.

    Parameters
    ----------
    path : str or Path
        Text: the number of wavelengths, the wavelengths [nm], then rows of theta_i, phi_i, theta_s, phi_s
        [radians; the mirror direction is at phi_s - phi_i = pi] and the reflectance [1/sr] at each
        wavelength; lines that start with # are comments.

    Returns
    -------
    Scattered
        In linear Rec. 709; its spec is `cornell:path=` and the path.

    Raises
    ------
    InputFileError
        The file is missing or unreadable, no such text, ends within a row, has angles beyond the horizon or
        too few samples that hold light.

    Warns
    -----
    RsibrWarning
        Reflectances are negative or NaN, or colours are outside Rec. 709; they are taken as 0; says how many.
        See also `told_wavelengths`.
    """
    wavelength, rows = _parse(path)
    theta_i, phi_i, theta_s, phi_s = rows[:, :4].T
    if not np.all((rows[:, :4:2] >= 0.0) & (rows[:, :4:2] < np.pi / 2.0)):
        raise InputFileError(f"{path} has polar angles that are not from 0 to pi/2 radians: convert them.")
    if not np.isfinite(rows[:, 1:4:2]).all():
        raise InputFileError(f"{path} has azimuths that are NaN or infinite: fetch it again.")
    spectra = _floored(
        rows[:, 4:], f"{path} holds {{}} reflectances that are negative or NaN; they are taken as 0."
    )
    try:
        colors = rec709_from_spectrum(told_wavelengths(wavelength, str(path)), spectra)
        colors = _floored(colors, f"{path} has {{}} values of colours outside Rec. 709; they are taken as 0.")
        directions = _direction(theta_i, phi_i), _direction(theta_s, phi_s)
        return scattered_brdf(*directions, colors, f"cornell:path={path}")
    except RangeError as error:
        raise InputFileError(f"{path} cannot be used: {error}") from error


def _parse(path: str | Path) -> tuple[Array, Array]:
    """Wavelengths, shape (W,), and samples, shape (N, 4 + W)."""
    with opened(path) as stream:
        data = stream.read(LARGEST + 1)
    if len(data) > LARGEST:
        raise InputFileError(f"{path} is larger than any measurement of Cornell's: give another file.")
    lines = data.decode("latin-1").splitlines()
    text = " ".join(line for line in lines if not line.lstrip().startswith(COMMENT))
    try:
        numbers = np.array(text.split(), dtype=np.float64)
        count = int(numbers[0]) if numbers.size else 0
        wavelength, samples = numbers[1 : 1 + count], numbers[1 + count :]
        if count < 2 or wavelength.size < count or not samples.size:
            raise ValueError("it has no spectra")
        if samples.size % (4 + count):
            raise ValueError(f"it ends within a row of {4 + count} numbers")
    except (ValueError, OverflowError) as error:
        raise InputFileError(
            f"{path} is no measurement of Cornell's, or truncated or damaged ({error!s:.99}): fetch it again."
        ) from error
    return wavelength, samples.reshape(-1, 4 + count)


def _floored(values: Array, sentence: str) -> Array:
    """`values` with 0 for those that are negative or not finite, and a warning that counts them."""
    usable = np.isfinite(values) & (values >= 0.0)
    if count := int(np.count_nonzero(~usable)):
        warn(sentence.format(count))
    return np.where(usable, values, 0.0)


def _direction(theta: Array, phi: Array) -> Array:
    return np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1)
