"""Fresnel terms as sums of powers of 1 - cos: what makes the lobes of all materials linear in a few.

Schlick's term is one power, and Cycles' tint of a metal's edge two more. The exact term of a dielectric is a
sum of four to .2 % of itself (root mean square over n.v, indices 1.3 to 2.5), where Schlick's misses 12 %.
"""

import numpy as np

from ..brdf.fresnel import fresnel_conductor
from ..conventions import Array, ArrayLike

POWERS = (0, 2, 5, 6, 7)
"""Exponents of 1 - cos, cos between light and half vector."""

_COSINE = (np.arange(256) + 0.5) / 256.0


def powers_of(cosine: ArrayLike) -> Array:
    """The powers themselves.

    Parameters
    ----------
    cosine : array_like, shape (...,)
        In [0, 1].

    Returns
    -------
    ndarray, shape (..., C)
        (1 - cosine) ** `POWERS`.
    """
    powers: Array = (1.0 - np.asarray(cosine, dtype=np.float64))[..., None] ** np.array(POWERS)
    return powers


def schlick(f0: ArrayLike, edge: ArrayLike = 0.0) -> Array:
    """Coefficients of Schlick's term, less a tint of a metal's edge.

    Parameters
    ----------
    f0 : array_like, shape (...,)
        Reflectance at normal incidence.
    edge : array_like, broadcastable to `f0`
        b of [Kutz2021] Eq. 3: what is taken away, as b cos (1 - cos)^6.

    Returns
    -------
    ndarray, shape (..., C)
    """
    f0, edge = np.broadcast_arrays(np.asarray(f0, dtype=np.float64), np.asarray(edge, dtype=np.float64))
    return np.stack([f0, np.zeros_like(f0), 1.0 - f0, -edge, edge], axis=-1)


def rise(index: ArrayLike) -> Array:
    """Coefficients of a dielectric's way from its F0, where they are 0, to 1 at grazing.

    Parameters
    ----------
    index : array_like, shape (...,)
        Index of refraction, of a dielectric in air; not 1.

    Returns
    -------
    ndarray, shape (..., C)
        Of (F - F0) / (1 - F0), F the exact term; the least squares of relative errors.
    """
    index = np.asarray(index, dtype=np.float64)
    flat = index.reshape(-1)
    exact = fresnel_conductor(_COSINE[:, None], flat, 0.0)
    f0 = ((flat - 1.0) / (flat + 1.0)) ** 2
    basis = powers_of(_COSINE)[:, 1:]
    # Shares of a sphere's picture, of which mu counts by itself
    price = np.sqrt(_COSINE)[:, None] / exact
    coefficients = np.zeros((len(flat), len(POWERS)))
    for row, value, weight in zip(coefficients, ((exact - f0) / (1.0 - f0)).T, price.T, strict=True):
        row[1:] = np.linalg.lstsq(basis * weight[:, None], value * weight, rcond=None)[0]
    return coefficients.reshape(*index.shape, len(POWERS))


def dielectric(index: ArrayLike) -> Array:
    """Coefficients of a dielectric's exact term: see `rise`.

    Returns
    -------
    ndarray, shape (..., C)
    """
    f0 = ((np.asarray(index, dtype=np.float64) - 1.0) / (np.asarray(index) + 1.0)) ** 2
    coefficients = (1.0 - f0)[..., None] * rise(index)
    coefficients[..., 0] += f0
    return coefficients
