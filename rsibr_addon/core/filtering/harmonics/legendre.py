"""Legendre polynomials: sums of their values at given angles, and their series."""

from typing import Any

import ducc0
import numpy as np

from ...conventions import Array
from ...threads import starting, thread_count


def legendre_sums(weight: Array, theta: Array, degree: int) -> Array:
    """Sum of weight times P_l(cos theta), for every degree.

    Parameters
    ----------
    weight, theta : ndarray, shape (points,)
        Factors, and angles in [0, pi].
    degree : int
        Largest degree.

    Returns
    -------
    ndarray, shape (degree + 1,)
    """
    with starting():
        found = ducc0.sht.adjoint_synthesis(map=weight[None], lmax=degree, **_meridian(theta))
    sums: Array = found[0].real / _normalisation(degree)
    return sums


def legendre_series(coefficients: Array, theta: Array) -> Array:
    """Sum over the degrees of coefficient times P_l(cos theta).

    Parameters
    ----------
    coefficients : ndarray, shape (degree + 1,)
    theta : ndarray, shape (points,)
        Angles in [0, pi].

    Returns
    -------
    ndarray, shape (points,)
    """
    degree = len(coefficients) - 1
    harmonics = (coefficients / _normalisation(degree)).astype(np.complex128)
    with starting():
        values: Array = ducc0.sht.synthesis(alm=harmonics[None], lmax=degree, **_meridian(theta))[0]
    return values


def _normalisation(degree: int) -> Array:
    """The harmonics of order 0 over Legendre's polynomials, for every degree."""
    return np.sqrt((2 * np.arange(degree + 1) + 1) / (4.0 * np.pi))


def _meridian(theta: Array) -> dict[str, Any]:
    """How ducc0 knows points on one meridian: rings of one point each, which need order 0 alone."""
    points = len(theta)
    return {
        "theta": theta,
        "phi0": np.zeros(points),
        "nphi": np.ones(points, np.uint64),
        "ringstart": np.arange(points, dtype=np.uint64),
        "spin": 0,
        "mmax": 0,
        "mstart": np.zeros(1, np.uint64),
        "nthreads": thread_count(),
    }
