"""The best profiles for given axes, and how the error changes with the axes: variable projection.

Everything is a scalar product over the sphere. Those of kernels are known in closed form, those of kernels
with the target are one quadrature. So the profiles of all lobes and all channels are one small linear system.
[Golub1973] eliminate such linear unknowns from a least-squares problem. There remains a function of the axes
(and of the weights of taps) alone, with the gradient and, as [Kaufman1975] simplifies it, the Gauss-Newton
matrix below.
"""

from dataclasses import dataclass

import numpy as np

from ..conventions import Array
from .bank import KernelBank
from .nonnegative import nonnegative_inverse
from .target import TargetSlice

UNIFORM_LIGHT = 10.0
"""Weight of an error under uniform light, relative to the same error of the lobe's shape."""

SHAPE_RIDGE, LIGHT_RIDGE = 5e-5, 1e-6
"""Penalties on the lobes' own power, and on each kernel under uniform light, in units of the target's. They
keep signed lobes from cancelling each other, and hardly raise the error.
"""

_RANK = 1e-6


@dataclass(frozen=True)
class Lookups:
    """Lookups of lobes at one elevation, all in the plane of incidence.

    Attributes
    ----------
    angles : ndarray, shape (J, T)
        Angles of the axes from the normal, positive on the side of the mirror direction [rad].
    taps : ndarray, shape (J, T)
        Weights of each lobe's taps.
    """

    angles: Array
    taps: Array


@dataclass(frozen=True)
class Projection:
    """The best profiles for given lookups.

    Attributes
    ----------
    weights : ndarray, shape (J, K, C)
        Weights of the kernels.
    objective : float
        Squared error with what `UNIFORM_LIGHT` and the ridges add, over the target's power.
    gradient : ndarray, shape (2 J T,)
        Gradient of the objective with respect to all angles and then all taps.
    hessian : ndarray, shape (2 J T, 2 J T)
        The Gauss-Newton approximation of its second derivatives.
    """

    weights: Array
    objective: float
    gradient: Array
    hessian: Array


class Projector:
    """Finds profiles for one target.

    Parameters
    ----------
    target : TargetSlice
    bank : KernelBank
    stiffness : float
        Factor of both ridges.
    non_negative : bool
        Whether no kernel may have a negative weight.

    Attributes
    ----------
    own : ndarray, shape (K, K)
        Scalar products of the kernels about one axis, of unit power each.
    """

    def __init__(
        self, target: TargetSlice, bank: KernelBank, stiffness: float = 1.0, non_negative: bool = False
    ) -> None:
        self.target, self.bank, self.non_negative = target, bank, non_negative
        norm, self._channels = np.sqrt(target.power), len(target.albedo)
        light = target.weight[:, None] * target.lobe / norm
        x, _, z = target.light_dir.T[..., None]
        self._weighted = np.stack([x * light, z * light, light], axis=1).reshape(len(light), -1)
        self._albedo = target.albedo / norm
        per_light = 1.0 / float(np.sum(self._albedo**2))
        self._light = UNIFORM_LIGHT * per_light
        own = bank.products(np.zeros(()))[0]
        # Coefficients of kernels of unit power keep the systems well scaled
        self._unit = 1.0 / np.sqrt(own.diagonal())
        self.own = own * np.outer(self._unit, self._unit)
        own = self.own + _RANK * np.eye(len(bank))
        price = LIGHT_RIDGE * per_light * self._unit**2
        self._ridge = stiffness * (SHAPE_RIDGE * own + np.diag(price))

    def objective(self, lookups: Lookups) -> float:
        """`Projection.objective` alone, for less."""
        moments, _ = self._moments(lookups.angles.ravel())
        products, _, _ = self._products(lookups.angles.ravel())
        return self._solve(lookups, moments, products)[2]

    def profiles(self, lookups: Lookups) -> Array:
        """`Projection.weights` alone, for less.

        Returns
        -------
        ndarray, shape (J, K, C)
        """
        moments, _ = self._moments(lookups.angles.ravel())
        products, _, _ = self._products(lookups.angles.ravel())
        return self.weights(self._solve(lookups, moments, products)[0])

    def equations(self, lookups: Lookups) -> tuple[Array, Array]:
        """Equations of the coefficients for given lookups; see `weights`.

        Returns
        -------
        system : ndarray, shape (J K, J K)
        right : ndarray, shape (J K, C)
        """
        moments, _ = self._moments(lookups.angles.ravel())
        products, _, _ = self._products(lookups.angles.ravel())
        system = _summed_over_taps(_summed_over_taps(products, lookups.taps).T, lookups.taps)
        return system, _summed_over_taps(moments, lookups.taps)

    def weights(self, coefficients: Array) -> Array:
        """Weights of kernels from their coefficients.

        Parameters
        ----------
        coefficients : ndarray, shape (J, K, C)
            In units of the kernels' power and the target's.

        Returns
        -------
        ndarray, shape (J, K, C)
        """
        weights: Array = coefficients * self._unit[:, None] * np.sqrt(self.target.power)
        return weights

    def project(self, lookups: Lookups) -> Projection:
        """Find the profiles and the derivatives."""
        lobes, taps = lookups.angles.shape
        count, tap = lobes * taps, lookups.taps.ravel()
        moments, slopes = self._moments(lookups.angles.ravel())
        products, first, second = self._products(lookups.angles.ravel())
        coefficients, inverse, objective = self._solve(lookups, moments, products)
        # Each derivative is a function on the sphere: with respect to an angle the tap times the slope of its
        # profile there, with respect to a tap the profile itself. Row: kernel of an axis; column: axis
        profiles = np.zeros((count, len(self.bank), count, self._channels))
        profiles[np.arange(count), :, np.arange(count)] = np.repeat(coefficients, taps, axis=0)
        profiles = profiles.reshape(-1, count, self._channels)
        slopes_of = profiles * tap[:, None]
        with_kernels = np.concatenate(
            [-np.tensordot(first, slopes_of, 1), np.tensordot(products, profiles, 1)], axis=1
        )
        pairs = np.empty((2, count, 2, count))
        pairs[0, :, 0] = -np.einsum("rpc,rqc->pq", slopes_of, np.tensordot(second, slopes_of, 1))
        pairs[0, :, 1] = np.einsum("rpc,rqc->pq", slopes_of, np.tensordot(first, profiles, 1))
        pairs[1, :, 0] = pairs[0, :, 1].T
        pairs[1, :, 1] = np.einsum("rpc,rqc->pq", profiles, np.tensordot(products, profiles, 1))
        with_target = np.concatenate(
            [np.einsum("rpc,rc->p", slopes_of, slopes), np.einsum("rpc,rc->p", profiles, moments)]
        )
        with_lobes = _summed_over_taps(with_kernels, lookups.taps)
        fitted = np.einsum("rpc,rc->p", with_lobes, coefficients.reshape(-1, self._channels))
        seen = np.einsum("crs,spc->rpc", inverse, with_lobes, optimize=True)
        hessian = pairs.reshape(2 * count, 2 * count) - np.einsum("rpc,rqc->pq", with_lobes, seen)
        return Projection(
            self.weights(coefficients),
            objective,
            2.0 * (fitted - with_target),
            2.0 * hessian,
        )

    def _moments(self, angles: Array) -> tuple[Array, Array]:
        """Products of kernels with the target, and their slopes over the angle, shapes (count * K, C)."""
        x, y, z = self.target.light_dir.T
        sine, cosine = np.sin(angles)[:, None], np.cos(angles)[:, None]
        distance = 0.25 * ((x - sine) ** 2 + y**2 + (z - cosine) ** 2)
        sums = np.empty((len(angles), len(self.bank), 3, self._channels))
        for k, fall in enumerate(self.bank.falls(distance)):
            sums[:, k] = (fall @ self._weighted).reshape(-1, 3, self._channels)
        sums *= (self.bank.peaks * self._unit)[:, None, None]
        # The slope of x sin + z cos, times kappa, is that of a kernel's logarithm
        slopes = cosine[..., None] * sums[:, :, 0] - sine[..., None] * sums[:, :, 1]
        slopes *= self.bank.kappa[:, None]
        moments = sums[:, :, 2] + self._light * self._unit[:, None] * self._albedo
        return moments.reshape(-1, self._channels), slopes.reshape(-1, self._channels)

    def _products(self, angles: Array) -> tuple[Array, Array, Array]:
        """Products of kernels with kernels, and derivatives, shapes (count * K, count * K).

        Uniform light is one more place where functions are compared, and the ridge is one more for every
        axis.
        """
        size = len(angles) * len(self.bank)
        units = np.outer(self._unit, self._unit)
        products, first, second = (
            (part * units).transpose(0, 2, 1, 3).reshape(size, size)
            for part in self.bank.products(angles[:, None] - angles)
        )
        light = np.tile(self._unit, len(angles))
        products += self._light * np.outer(light, light)
        products += np.kron(np.eye(len(angles)), self._ridge)
        return products, first, second

    def _solve(self, lookups: Lookups, moments: Array, products: Array) -> tuple[Array, Array, float]:
        """Coefficients, shape (J, K, C), the inverse of each channel's system, and the objective."""
        right = _summed_over_taps(moments, lookups.taps)
        system = _summed_over_taps(_summed_over_taps(products, lookups.taps).T, lookups.taps)
        if self.non_negative:
            inverse = np.stack([nonnegative_inverse(system, channel) for channel in right.T])
        else:
            inverse = np.broadcast_to(np.linalg.inv(system), (self._channels, *system.shape))
        coefficients = np.einsum("crs,sc->rc", inverse, right)
        # In this form, rounding of the inverse counts only squared
        error = system @ coefficients - 2.0 * right
        objective = 1.0 + UNIFORM_LIGHT + float(np.sum(coefficients * error))
        return coefficients.reshape(len(lookups.taps), -1, self._channels), inverse, objective


def _summed_over_taps(rows: Array, taps: Array) -> Array:
    """From rows for every axis and kernel, rows for every lobe and kernel."""
    lobes, count = taps.shape
    by_tap = rows.reshape(lobes, count, -1, *rows.shape[1:])
    summed: Array = np.einsum("jt,jt...->j...", taps, by_tap)
    return summed.reshape(-1, *rows.shape[1:])
