"""Radially symmetric lobes, their zonal coefficients, and where these may be cut.

A lobe is a function K of the angle to its axis. Its zonal coefficients
p_l = 2 pi * integral of K(cos) P_l(cos) over the cosine from -1 to 1 (equation 2) are the factors by which
filtering multiplies the degrees of an environment; p_0 is its integral over the sphere.
"""

import functools
import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..conventions import Array
from ..errors import RangeError
from .harmonics.analysis import MAX_DEGREE
from .harmonics.legendre import legendre_series, legendre_sums

TOLERANCE = 1e-6
"""Default relative root-mean-square error: dark texels beside a sun need it."""

_NODES = 64
_SPARE_NODES = 40
_DEGREES_TIMES_WIDTH = 90.0
_LARGEST_SEEN = 3 * MAX_DEGREE // 2
_HEADROOM = 4.0 / 3.0


@dataclass(frozen=True)
class ZonalLobe:
    """A lobe that depends on the angle to its axis only.

    Attributes
    ----------
    profile : callable
        Values [1/sr] from lobe angles in [0, pi], both of any one shape.
    knots : tuple of float
        Lobe angles, ascending from 0 to pi. Between two neighbours the profile is smooth: a polynomial
        of degree 40 in the angle meets it. A narrow lobe needs knots around its width: `graded_knots`.
    closed_form : callable or None
        Zonal coefficients, shape (degree + 1,), from a degree, where a formula for them is known.
    """

    profile: Callable[[Array], Array]
    knots: tuple[float, ...]
    closed_form: Callable[[int], Array] | None = None


@dataclass(frozen=True)
class ZonalSeries:
    """A lobe with as many zonal coefficients as a tolerance needs; made by `expand`.

    Attributes
    ----------
    lobe : ZonalLobe
    tolerance : float
        Relative root-mean-square error, over the sphere, of maps filtered with the lobe.
    coefficients : ndarray, shape (degree + 1,)
        p_0 ... p_degree. The degree is a third higher than where a single small sun allows a cut, so that the
        power that any cut leaves out is known, not only bounded.
    width : float
        Angle [rad] across the disk with the lobe's solid angle, (integral of |K|)^2 / integral of K^2.
    signed : bool
        The profile is negative somewhere.
    """

    lobe: ZonalLobe
    tolerance: float
    coefficients: Array
    width: float
    signed: bool

    @property
    def degree(self) -> int:
        """The degree to which an environment must be analysed."""
        return len(self.coefficients) - 1

    def truncation_errors(self, *degrees: int) -> Array:
        """Largest difference between the lobe and its series, cut after some degrees.

        Parameters
        ----------
        *degrees : int
            Each at most `degree`.

        Returns
        -------
        ndarray, shape (len(degrees),)
            max over the angle of |K - sum of (2 l + 1) / (4 pi) p_l P_l| [1/sr]. Times the flux it bounds
            the error of a filtered environment (equation 7), and it never exceeds the sum of
            (2 l + 1) / (4 pi) |p_l| over all degrees that are left out.

        Notes
        -----
        Found at the knots, both ends among them, and at five points for every wave of P_degree.
        """
        angle = np.concatenate([self.lobe.knots, _quadrature(self.lobe.knots, self.degree)[0]])
        values = self.lobe.profile(angle)
        series = (2 * np.arange(self.degree + 1) + 1) / (4.0 * np.pi) * self.coefficients
        return np.array([np.abs(values - legendre_series(series[: l + 1], angle)).max() for l in degrees])


def expand(lobe: ZonalLobe, tolerance: float = TOLERANCE) -> ZonalSeries:
    """Zonal coefficients of a lobe, as many as matter.

    Parameters
    ----------
    lobe : ZonalLobe
    tolerance : float
        1e-12 ... 0.1; see `ZonalSeries`.

    Raises
    ------
    RangeError
        The tolerance is out of range; the profile is NaN, infinite or 0 throughout, or so narrow or so
        little smooth that `MAX_DEGREE` does not suffice.
    """
    if not 1e-12 <= tolerance <= 0.1:
        raise RangeError(f"A tolerance of {tolerance} is out of range: choose one from 1e-12 to 0.1.")
    angle, weight = _quadrature(lobe.knots, 0)
    values = lobe.profile(angle)
    if not np.all(np.isfinite(values)) or not np.any(values):
        raise RangeError("A lobe's profile is NaN, infinite or 0 throughout: correct it.")
    solid_angle = float((weight @ np.abs(values)) ** 2 / (weight @ values**2))
    width = 4.0 * math.asin(math.sqrt(min(solid_angle / (4.0 * math.pi), 1.0)))
    coefficients = _sufficient_coefficients(lobe, tolerance, width)
    return ZonalSeries(lobe, tolerance, coefficients, width, bool(np.any(values < 0.0)))


def _sufficient_coefficients(lobe: ZonalLobe, tolerance: float, width: float) -> Array:
    """Coefficients until tolerance^2 of the sum of (2 l + 1) p_l^2 is left, and a third more: equation 8."""
    degree = min(16 + int(_DEGREES_TIMES_WIDTH / width), _LARGEST_SEEN)
    while True:
        p = zonal_coefficients(lobe, degree)
        power = (2 * np.arange(degree + 1) + 1) * p**2
        tail = np.cumsum(power[::-1])[::-1]
        sufficient = max(int(np.count_nonzero(tail > tolerance**2 * tail[0])) - 1, 1)
        # The last third of the coefficients has to show that the tail has ended.
        if 3 * sufficient <= 2 * degree and sufficient <= MAX_DEGREE:
            return p[: min(int(np.ceil(_HEADROOM * sufficient)), MAX_DEGREE) + 1]
        if degree == _LARGEST_SEEN:
            raise RangeError(
                f"A lobe {np.degrees(width):.3g} degrees wide needs more than {MAX_DEGREE} degrees of "
                f"harmonics for a tolerance of {tolerance:.1g}: make it wider or smoother, or allow more."
            )
        degree = min(2 * degree, _LARGEST_SEEN)


def zonal_coefficients(lobe: ZonalLobe, degree: int) -> Array:
    """Coefficients p_0 ... p_degree of a lobe.

    Returns
    -------
    ndarray, shape (degree + 1,)
        Accurate to about 1e-15 of the integral of |K|.
    """
    if lobe.closed_form is not None:
        return lobe.closed_form(degree)
    angle, weight = _quadrature(lobe.knots, degree)
    return legendre_sums(weight * lobe.profile(angle), angle, degree)


def graded_knots(width: float) -> tuple[float, ...]:
    """Knots for a profile that varies over `width` near its axis and ever slower away from it.

    Parameters
    ----------
    width : float
        Radians.

    Returns
    -------
    tuple of float
        0, width and its doubles, pi.
    """
    knots = [0.0]
    while width < 0.75 * np.pi:
        knots.append(width)
        width *= 2.0
    return (*knots, np.pi)


def _quadrature(knots: tuple[float, ...], degree: int) -> tuple[Array, Array]:
    """Nodes and weights for the integral over the sphere of a profile times P_l, l <= `degree`.

    Gauss-Legendre panels in the angle between any two knots. There are so many panels that their spare nodes
    can follow the waves of P_l: half a node per radian of degree * angle, as for any polynomial.
    """
    width = np.diff(knots)
    panels = 1 + (0.5 * degree / _SPARE_NODES * width).astype(np.intp)
    half = np.repeat(0.5 * width / panels, panels)
    # Panel k of an interval ends at its start plus 2 (k + 1) halves.
    within = np.arange(len(half)) - np.repeat(np.cumsum(panels) - panels, panels)
    centre = np.repeat(knots[:-1], panels) + (2 * within + 1) * half
    x, w = _gauss_legendre()
    angle = (centre[:, None] + half[:, None] * x).ravel()
    return angle, 2.0 * np.pi * (half[:, None] * w).ravel() * np.sin(angle)


@functools.cache
def _gauss_legendre() -> tuple[Array, Array]:
    return np.polynomial.legendre.leggauss(_NODES)
