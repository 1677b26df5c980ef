"""Irradiance: from a few spherical harmonics, and exactly.

Irradiance is the environment filtered with the cosine lobe. That lobe is so wide that harmonics up to degree
2, nine numbers for each channel, give it within a few per cent [Ramamoorthi2001], as [Kautz2004] section 4.1
uses them; degree 4 is closer still. The lobe's kink at the horizon keeps harmonics from ever being exact, so
the exact sum over all texels takes another way.

>>> harmonics = analyse_environment(environment.radiance, degree=2)
>>> irradiance = irradiance_from_harmonics(harmonics.real(2), normals)
"""

import math

import numpy as np

from ..conventions import Array, ArrayLike
from ..errors import ShapeError
from ..geometry.directions import normalize
from ..maps import equirect
from .radial_lobes import cosine_lobe
from .zonal import zonal_coefficients


def real_harmonics(direction: ArrayLike, degree: int) -> Array:
    """Real spherical harmonics.

    Parameters
    ----------
    direction : array_like, shape (..., 3)
        Unit vectors.
    degree : int
        Largest degree, at least 0; meant to be small.

    Returns
    -------
    ndarray, shape (..., (degree + 1)**2), float64
        Y_lm at l (l + 1) + m for m = -l ... l: 0.282095, then 0.488603 times y, z, x, then
        1.092548 xy, 1.092548 yz, 0.315392 (3 z^2 - 1), 1.092548 xz, 0.546274 (x^2 - y^2), ...

    Notes
    -----
    Orthonormal, without Condon-Shortley phase: [Ramamoorthi2001] Eq. 3. As lambda_lm / sin^m is a
    polynomial in z and sin^m exp(i m phi) is (x + i y)^m, the poles are like any other direction.
    """
    direction = np.asarray(direction, dtype=np.float64)
    x, y, z = direction[..., 0], direction[..., 1], direction[..., 2]
    harmonics = np.empty((*z.shape, (degree + 1) ** 2))
    power = np.ones(z.shape, dtype=np.complex128)
    sectoral = np.sqrt(0.25 / np.pi)
    for m in range(degree + 1):
        before, last, a_before = np.zeros_like(z), np.full_like(z, sectoral), 1.0
        for l in range(m, degree + 1):
            if l > m:
                a = np.sqrt((4.0 * l**2 - 1.0) / (l**2 - m**2))
                before, last, a_before = last, a * (z * last - before / a_before), a
            index = l * (l + 1)
            if m == 0:
                harmonics[..., index] = last
            else:
                harmonics[..., index + m] = np.sqrt(2.0) * last * power.real
                harmonics[..., index - m] = np.sqrt(2.0) * last * power.imag
        sectoral *= np.sqrt((2.0 * m + 3.0) / (2.0 * m + 2.0))
        power = power * (x + 1j * y)
    return harmonics


def irradiance_from_harmonics(coefficients: ArrayLike, normal: ArrayLike) -> Array:
    """Irradiance from spherical harmonic coefficients of the radiance.

    Parameters
    ----------
    coefficients : array_like, shape ((degree + 1)**2, channels)
        Coefficients of `real_harmonics`: nine for degree 2.
    normal : array_like, shape (..., 3)
        Unit vectors.

    Returns
    -------
    ndarray, shape (..., channels), float64
        Sum of A_l L_lm Y_lm: [Ramamoorthi2001] Eq. 7, [Kautz2004] Eq. 12. Not divided by pi; it may be
        slightly negative opposite a strong light.

    Raises
    ------
    ShapeError
        The number of coefficients is not a square.

    Notes
    -----
    GLSL twin: gpu_shaders/lib/irradiance_lib.glsl `irradiance`, 2e-6 of the coefficients' sum.
    """
    convolved = irradiance_coefficients(coefficients)
    irradiance: Array = real_harmonics(normal, degree_of(convolved)) @ convolved
    return irradiance


def irradiance_coefficients(coefficients: ArrayLike) -> Array:
    """Coefficients of the irradiance from those of the radiance.

    Parameters
    ----------
    coefficients : array_like, shape ((degree + 1)**2, channels)
        Coefficients of `real_harmonics`: nine for degree 2.

    Returns
    -------
    ndarray, shape ((degree + 1)**2, channels), float64
        A_l L_lm of [Ramamoorthi2001] Eq. 5: of the irradiance itself, not divided by pi.

    Raises
    ------
    ShapeError
        The number of coefficients is not a square.
    """
    coefficients = np.asarray(coefficients, dtype=np.float64)
    degree = degree_of(coefficients)
    a = np.repeat(zonal_coefficients(cosine_lobe(), degree), 2 * np.arange(degree + 1) + 1)
    convolved: Array = a[:, None] * coefficients
    return convolved


def degree_of(coefficients: Array) -> int:
    """The degree of the harmonics whose coefficients they are.

    Parameters
    ----------
    coefficients : ndarray, shape ((degree + 1)**2, ...)

    Raises
    ------
    ShapeError
        The number of coefficients is not a square.
    """
    degree = math.isqrt(len(coefficients)) - 1
    if degree < 0 or (degree + 1) ** 2 != len(coefficients):
        raise ShapeError(f"{len(coefficients)} coefficients are not those of any degree: give 9, or 25.")
    return degree


def diffuse_terms(coefficients: ArrayLike) -> Array:
    """The nine coefficients of degree 2 as factors of products of the normal's components.

    Parameters
    ----------
    coefficients : array_like, shape (9, channels)
        Coefficients of `real_harmonics`.

    Returns
    -------
    ndarray, shape (9, channels), float64
        Factors of 1, y, z, x, xy, yz, 3 z^2 - 1, xz and x^2 - y^2, whose sum is the irradiance of
        `irradiance_from_harmonics` over pi: what a white matte surface of normal (x, y, z) reflects.

    Raises
    ------
    ShapeError
        The coefficients are not nine.
    """
    convolved = irradiance_coefficients(coefficients)
    if len(convolved) != 9:
        raise ShapeError(f"{len(convolved)} coefficients are not those of degree 2: give nine.")
    # [Ramamoorthi2001] Eq. 3
    factors = np.sqrt(np.array([1.0, 3.0, 3.0, 3.0, 15.0, 15.0, 1.25, 15.0, 3.75]) / (4.0 * np.pi))
    terms: Array = factors[:, None] * convolved / np.pi
    return terms


def turned_harmonics(coefficients: Array, rotation: Array) -> Array:
    """The coefficients of radiance that has been turned.

    Parameters
    ----------
    coefficients : ndarray, shape ((degree + 1)**2, channels)
        Coefficients of `real_harmonics`.
    rotation : ndarray, shape (3, 3)
        New directions from old ones.

    Returns
    -------
    ndarray, shape ((degree + 1)**2, channels), float64

    Notes
    -----
    A turned harmonic is a sum of those of its own degree. So a product rule on the sphere that is exact for
    products of two harmonics gives the new coefficients exactly.
    """
    degree = degree_of(coefficients)
    direction, weight = _quadrature(degree)
    radiance = real_harmonics(direction @ rotation, degree) @ coefficients
    made: Array = (real_harmonics(direction, degree) * weight[:, None]).T @ radiance
    return made


def _quadrature(degree: int) -> tuple[Array, Array]:
    """Directions, shape (n, 3), and weights of a sum that is exact for products of two harmonics.

    Gauss-Legendre in z times equal steps around.
    """
    z, along = np.polynomial.legendre.leggauss(degree + 1)
    around = 2 * degree + 1
    phi = 2.0 * np.pi * np.arange(around) / around
    radius = np.sqrt(1.0 - z**2)[:, None]
    direction = np.stack(
        np.broadcast_arrays(radius * np.cos(phi), radius * np.sin(phi), z[:, None]), axis=-1
    ).reshape(-1, 3)
    return direction, np.repeat(2.0 * np.pi / around * along, around)


def irradiance_exact(radiance: Array, normal: ArrayLike) -> Array:
    """Irradiance as the sum over all texels of radiance, solid angle and cosine.

    Parameters
    ----------
    radiance : ndarray, shape (height, width, channels)
        Latitude-longitude map.
    normal : array_like, shape (..., 3)
        Vectors of any positive length.

    Returns
    -------
    ndarray, shape (..., channels), float64
        Not divided by pi.

    Raises
    ------
    RangeError
        A normal has length 0 or is not finite.

    Notes
    -----
    Along a row of the map n.l is positive on one arc, and there it is a sum of 1, cos(phi) and sin(phi):
    with running sums of radiance times these three, each row takes two lookups instead of a sum.
    """
    height, width, channels = radiance.shape
    normal = normalize(normal)
    n = normal.reshape(-1, 3)
    horizontal = np.hypot(n[:, 0], n[:, 1])
    azimuth = np.arctan2(n[:, 1], n[:, 0])
    directions = equirect.direction_from_uv(_row_centres(height))
    solid_angle = equirect.texel_solid_angle(width, height)[:, 0]
    phi = np.pi * (1.0 - 2.0 * (np.arange(width) + 0.5) / width)
    waves = np.stack([np.ones(width), np.cos(phi), np.sin(phi)], axis=-1)
    # Of each row's light times 1, cos(phi) and sin(phi), what the normals' arcs hold; summed over rows.
    arcs = np.zeros((len(n), 3 * channels))
    # Around the horizon twice, so that an arc may cross the seam.
    running = np.zeros((2 * width + 1, 3 * channels))
    for row in range(height):
        sine, cosine = np.hypot(*directions[row, :2]), directions[row, 2]
        weights = solid_angle[row] * np.array([cosine, sine, sine]) * waves
        light = weights[:, :, None] * radiance[row, :, None, :]
        np.cumsum(light.reshape(width, -1), axis=0, out=running[1 : width + 1])
        np.add(running[1 : width + 1], running[width], out=running[width + 1 :])
        # n.l = n_z cos(theta) + |n_xy| sin(theta) cos(phi - azimuth) is positive within this half arc.
        with np.errstate(divide="ignore", invalid="ignore"):
            edge = np.nan_to_num(-n[:, 2] * cosine / (horizontal * sine), nan=1.0)
        half_arc = np.arccos(np.clip(edge, -1.0, 1.0))
        # Columns run against phi; the first whose centre is inside, and the first beyond.
        first = np.ceil(width * (0.5 - (azimuth + half_arc) / (2.0 * np.pi)) - 0.5)
        beyond = np.ceil(width * (0.5 - (azimuth - half_arc) / (2.0 * np.pi)) - 0.5)
        # A row that is lit all around has no ends: rounded ends could drop the texel there.
        beyond = np.where(edge <= -1.0, first + width, beyond)
        lap = width * np.floor(first / width)
        arcs += np.take(running, (beyond - lap).astype(np.intp), axis=0)
        arcs -= np.take(running, (first - lap).astype(np.intp), axis=0)
    factors = n[:, [2, 0, 1]].reshape(*normal.shape[:-1], 3)
    irradiance: Array = np.einsum("...k,...kc->...c", factors, arcs.reshape(*normal.shape, channels))
    return irradiance


def _row_centres(height: int) -> Array:
    """The uv of one texel in each row, shape (height, 2)."""
    v = (np.arange(height) + 0.5) / height
    return np.stack([np.full(height, 0.5), v], axis=-1)
