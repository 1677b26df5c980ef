"""Fresnel terms as sums of powers of 1 - cos: what makes the lobes of all materials linear in a few.

Schlick's term is one power, and Cycles' tint of a metal's edge two more. The exact term of a dielectric is a
sum of four to .2 % of itself (root mean square over n.v, indices 1.3 to 2.5), where Schlick's misses 12 %.
"""

from functools import cache

import numpy as np

from ..conventions import Array, ArrayLike
from .fresnel import fresnel_conductor

POWERS = (0, 2, 5, 6, 7)
"""Exponents of 1 - cos, cos between light and half vector."""

AMPLITUDES = np.linspace(0.0, 1.0, 65)
"""(index - 1) / (index + 1), the root of F0, at which `rise_table` tells a dielectric's term."""

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
        What is taken away, as edge cos (1 - cos)^6: see `edge_of`.

    Returns
    -------
    ndarray, shape (..., C)
    """
    f0, edge = np.broadcast_arrays(np.asarray(f0, dtype=np.float64), np.asarray(edge, dtype=np.float64))
    return np.stack([f0, np.zeros_like(f0), 1.0 - f0, -edge, edge], axis=-1)


def edge_of(f0: ArrayLike, tint: ArrayLike) -> Array:
    """The tint of a metal's edge: what makes the reflectance at 82 degrees Schlick's times `tint`.

    Parameters
    ----------
    f0, tint : array_like, shapes (...,)
        In [0, 1].

    Returns
    -------
    ndarray, shape (...,)
        The b of [Kutz2021], whose angle has the cosine 1/7.
    """
    f0, tint = np.asarray(f0, dtype=np.float64), np.asarray(tint, dtype=np.float64)
    at_82 = f0 + (1.0 - f0) * (6.0 / 7.0) ** 5
    edge: Array = at_82 * (1.0 - tint) * 7.0 / (6.0 / 7.0) ** 6
    return edge


def rise(amplitude: ArrayLike) -> Array:
    """Coefficients of a dielectric's way from its F0, where they are 0, to 1 at grazing.

    Parameters
    ----------
    amplitude : array_like, shape (...,)
        (index - 1) / (index + 1), the root of F0, in [0, 1].

    Returns
    -------
    ndarray, shape (..., C)
        Of (F - F0) / (1 - F0), F the exact term: `rise_table`, interpolated.
    """
    table, amplitude = rise_table(), np.asarray(amplitude, dtype=np.float64)
    return np.stack([np.interp(amplitude, AMPLITUDES, column) for column in table.T], axis=-1)


def dielectric(index: ArrayLike) -> Array:
    """Coefficients of a dielectric's exact term.

    Parameters
    ----------
    index : array_like, shape (...,)
        Index of refraction, at least 1, in air.

    Returns
    -------
    ndarray, shape (..., C)
    """
    index = np.asarray(index, dtype=np.float64)
    amplitude = (index - 1.0) / (index + 1.0)
    coefficients = (1.0 - amplitude**2)[..., None] * rise(amplitude)
    coefficients[..., 0] += amplitude**2
    return coefficients


@cache
def rise_table() -> Array:
    """`rise` at `AMPLITUDES`, shape (65, C): the least squares of errors relative to the whole term."""
    table = np.zeros((len(AMPLITUDES), len(POWERS)))
    basis = powers_of(_COSINE)[:, 1:]
    # An index of 1 is no boundary, which reflects nothing at any angle; the last row is that of a metal
    for row, amplitude in zip(table[1:], np.minimum(AMPLITUDES[1:], 0.99), strict=True):
        exact = fresnel_conductor(_COSINE, (1.0 + amplitude) / (1.0 - amplitude), 0.0)
        # Cosines count as in a sphere's picture, by themselves
        price = np.sqrt(_COSINE) / exact
        wanted = (exact - amplitude**2) / (1.0 - amplitude**2)
        row[1:] = np.linalg.lstsq(basis * price[:, None], wanted * price, rcond=None)[0]
    return table
