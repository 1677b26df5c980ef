"""Radially symmetric lobes with a name: von Mises-Fisher, GGX about the mirror direction, cosine, Phong."""

import numpy as np

from ..conventions import Array
from ..errors import RangeError
from .zonal import ZonalLobe, graded_knots, zonal_coefficients


def von_mises_fisher_lobe(concentration: float) -> ZonalLobe:
    """The spherical Gaussian kappa / (4 pi sinh kappa) exp(kappa cos), which integrates to 1.

    Parameters
    ----------
    concentration : float
        kappa > 0; the lobe's width is about 1 / sqrt(kappa).

    Raises
    ------
    RangeError
        The concentration is not positive or not finite.
    """
    if not 0.0 < concentration < np.inf:
        raise RangeError(f"A concentration of {concentration} is out of range: choose one above 0.")
    peak = concentration / (-2.0 * np.pi * np.expm1(-2.0 * concentration))

    def profile(lobe_angle: Array) -> Array:
        # cos(angle) - 1 as a product, which keeps its digits in narrow lobes.
        values: Array = peak * np.exp(-2.0 * concentration * np.sin(0.5 * lobe_angle) ** 2)
        return values

    def coefficients(degree: int) -> Array:
        # Ratios p_l / p_{l-1} of modified Bessel functions, downwards, where the recurrence is stable;
        # it forgets a wrong start within as many steps as the last degree is above sqrt(kappa).
        start = degree + 40 + int(6.0 * np.sqrt(concentration))
        ratios = np.empty(start + 2)
        ratios[-1] = 0.0
        for l in range(start, 0, -1):
            ratios[l] = 1.0 / ((2 * l + 1) / concentration + ratios[l + 1])
        ratios[0] = 1.0
        return np.cumprod(ratios[: degree + 1])

    return ZonalLobe(profile, graded_knots(1.0 / np.sqrt(concentration)), coefficients)


def ggx_lobe(alpha: float) -> ZonalLobe:
    """Distribution of the half vector, GGX, as a lobe about the mirror direction: integrates to 1.

    Parameters
    ----------
    alpha : float
        roughness**2, in (0, 1].

    Returns
    -------
    ZonalLobe
        alpha^2 / (4 pi (alpha^2 cos^2 + sin^2)^2) of half the lobe angle: GGX at normal = view = mirror
        direction without its factor n.l, smooth on the whole sphere.

    Raises
    ------
    RangeError
        alpha is out of range.
    """
    _check_alpha(alpha)

    def profile(lobe_angle: Array) -> Array:
        values: Array = alpha**2 / (4.0 * np.pi * _ggx_root(lobe_angle, alpha) ** 2)
        return values

    return ZonalLobe(profile, graded_knots(alpha))


def ggx_n_dot_l_lobe(alpha: float) -> ZonalLobe:
    """GGX at normal = view = mirror direction times n.l, as engines prefilter: integrates to 1.

    0 beyond pi / 2, with a kink there: its coefficients fall slowly, so use a larger tolerance than for
    smooth lobes. `alpha` as that of `ggx_lobe`.

    Raises
    ------
    RangeError
        alpha is out of range.
    """
    _check_alpha(alpha)

    def unscaled(lobe_angle: Array) -> Array:
        values: Array = np.maximum(np.cos(lobe_angle), 0.0) / _ggx_root(lobe_angle, alpha) ** 2
        return values

    knots = tuple(sorted({*graded_knots(alpha), 0.5 * np.pi}))
    integral = zonal_coefficients(ZonalLobe(unscaled, knots), 0)[0]
    return ZonalLobe(lambda lobe_angle: unscaled(lobe_angle) / integral, knots)


def _check_alpha(alpha: float) -> None:
    if not 0.0 < alpha <= 1.0:
        raise RangeError(f"alpha = {alpha} is out of range: choose it above 0 and up to 1.")


def _ggx_root(lobe_angle: Array, alpha: float) -> Array:
    """alpha^2 cos^2 + sin^2 of half the lobe angle."""
    half = 0.5 * lobe_angle
    root: Array = (alpha * np.cos(half)) ** 2 + np.sin(half) ** 2
    return root


def cosine_lobe() -> ZonalLobe:
    """max(cos, 0), which integrates to pi: filtering with it turns radiance into irradiance.

    Returns
    -------
    ZonalLobe
        Its coefficients are A_l = pi, 2 pi / 3, pi / 4, 0, -pi / 24, ... of [Ramamoorthi2001] Eq. 8.
    """

    def profile(lobe_angle: Array) -> Array:
        values: Array = np.maximum(np.cos(lobe_angle), 0.0)
        return values

    def coefficients(degree: int) -> Array:
        found = np.zeros(max(degree, 1) + 1)
        found[:2] = np.pi, 2.0 * np.pi / 3.0
        even = np.arange(2, degree + 1, 2)
        # A_2 = pi / 4; A_{l+2} / A_l = -(l - 1) / (l + 4)
        steps = np.concatenate([[np.pi / 4.0], -(even[:-1] - 1.0) / (even[:-1] + 4.0)])
        found[even] = np.cumprod(steps)[: len(even)]
        return found[: degree + 1]

    return ZonalLobe(profile, (0.0, 0.5 * np.pi, np.pi), coefficients)


def phong_lobe(exponent: float) -> ZonalLobe:
    """(n + 1) / (2 pi) max(cos, 0)^n, which integrates to 1.

    Parameters
    ----------
    exponent : float
        n, at least 1; the lobe's width is about 1 / sqrt(n).

    Returns
    -------
    ZonalLobe
        Lobe of Phong's highlight about the mirror direction. Its n-th derivative jumps at pi / 2, so below
        n = 2 its coefficients fall slowly: use a larger tolerance there.

    Raises
    ------
    RangeError
        The exponent is below 1 or not finite.
    """
    if not 1.0 <= exponent < np.inf:
        raise RangeError(f"An exponent of {exponent} is out of range: choose 1 or more.")

    def profile(lobe_angle: Array) -> Array:
        powers: Array = np.maximum(np.cos(lobe_angle), 0.0) ** exponent
        return (exponent + 1.0) / (2.0 * np.pi) * powers

    def coefficients(degree: int) -> Array:
        # The integral of x^n P_l over [0, 1] is that of P_{l-2} times (n - l + 2) / (n + l + 1): integrate
        # Legendre's differential equation times x^n by parts.
        found = np.empty(max(degree, 1) + 1)
        found[:2] = 1.0, (exponent + 1.0) / (exponent + 2.0)
        l = np.arange(2, degree + 1)
        ratios = (exponent - l + 2.0) / (exponent + l + 1.0)
        for first in (0, 1):
            found[first + 2 :: 2] = found[first] * np.cumprod(ratios[first::2])
        return found[: degree + 1]

    knots = tuple(sorted({*graded_knots(1.0 / np.sqrt(exponent)), 0.5 * np.pi}))
    return ZonalLobe(profile, knots, coefficients)
