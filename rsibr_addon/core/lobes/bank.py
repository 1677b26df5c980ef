"""The kernels whose sums are the lobes' profiles: spherical Gaussians, each twice as sharp as the last.

Scalar products of von Mises-Fisher kernels are known in closed form, as are their zonal coefficients. An
environment that was filtered once with every kernel of a bank therefore holds the maps of every fit that
uses it: they are its kernels' maps times a small matrix.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..conventions import Array
from ..errors import RangeError
from ..filtering.radial_lobes import von_mises_fisher_lobe
from ..filtering.zonal import ZonalLobe, graded_knots, zonal_coefficients
from ..ties import TIE

BROADEST = 0.5
"""Concentration of the broadest kernel: nearly uniform over the sphere."""

SHARPEST, SHARP = 2.0**19, 2.0**15
"""Concentration of the sharpest kernel of fits to lobes with a core so thin, and of the sharpest one of other
fits and of kernel banks; environments of 4096x2048 and 1024x512 texels resolve them.
"""


@dataclass(frozen=True)
class KernelBank:
    """Von Mises-Fisher kernels kappa / (4 pi sinh kappa) exp(kappa cos), each of which integrates to 1.

    Attributes
    ----------
    concentrations : tuple of float
        kappa of each kernel, positive and ascending; a kernel is about 1 / sqrt(kappa) wide [rad].

    Raises
    ------
    RangeError
        There is no kernel, or the concentrations are not positive, finite and ascending.
    """

    concentrations: tuple[float, ...]

    def __post_init__(self) -> None:
        kappa = np.asarray(self.concentrations, dtype=np.float64)
        if not len(kappa) or not np.all(np.isfinite(kappa) & (kappa > 0.0)) or np.any(np.diff(kappa) <= 0.0):
            raise RangeError("Kernels need concentrations above 0 in ascending order.")

    def __len__(self) -> int:
        return len(self.concentrations)

    @cached_property
    def kappa(self) -> Array:
        """The concentrations, shape (K,)."""
        return np.array(self.concentrations)

    @cached_property
    def peaks(self) -> Array:
        """Values on the axis [1/sr], shape (K,)."""
        peaks: Array = self.kappa / (-2.0 * np.pi * np.expm1(-2.0 * self.kappa))
        return peaks

    def values(self, half_chord_squared: Array) -> Array:
        """Kernels by distance from their axis.

        Parameters
        ----------
        half_chord_squared : ndarray, shape (...,)
            (1 - cos angle) / 2 = sin^2(angle / 2), which keeps the digits of small angles.

        Returns
        -------
        ndarray, shape (..., K)
            [1/sr].
        """
        values: Array = self.peaks * np.exp(-2.0 * half_chord_squared[..., None] * self.kappa)
        return values

    def falls(self, half_chord_squared: Array) -> Iterator[Array]:
        """Kernels over their peaks, one after the other, faster than `values`.

        Parameters
        ----------
        half_chord_squared : ndarray, any shape
            As in `values`.

        Yields
        ------
        ndarray, shape of `half_chord_squared`
            exp(kappa (cos - 1)), valid until the next one is taken.
        """
        held: dict[float, Array] = {}
        for kappa in self.concentrations:
            fall = held.pop(0.5 * kappa, None)
            if fall is None:
                fall = np.exp(-2.0 * kappa * half_chord_squared)
            else:
                fall *= fall  # twice as sharp
            held[kappa] = fall
            yield fall

    def products(self, angle: Array) -> tuple[Array, Array, Array]:
        """Scalar products over the sphere of kernels about two axes, and their derivatives.

        Parameters
        ----------
        angle : ndarray, shape (...,)
            From the second axis to the first [rad], of any sign.

        Returns
        -------
        products, first, second : ndarray, shape (..., K, K)
            Integral of the product of kernel k about the one and kernel l about the other axis [1/sr], and
            its first and second derivative with respect to the angle.

        Notes
        -----
        exp(kappa a.w + lambda b.w) is one kernel about kappa a + lambda b, whose length R gives
        4 pi sinh(R) / R.
        """
        one, other = self.kappa[:, None], self.kappa[None, :]
        sine, cosine = np.sin(angle)[..., None, None], np.cos(angle)[..., None, None]
        half = (np.sin(0.5 * angle) ** 2)[..., None, None]
        product, together = one * other, one + other
        length = np.sqrt(np.maximum(together**2 - 4.0 * product * half, 1e-24))
        # R - (kappa + lambda) without cancellation
        fall = np.exp(-4.0 * product * half / (length + together))
        lost = np.exp(-2.0 * length)
        products = (2.0 * np.pi * self.peaks[:, None] * self.peaks) * fall * (1.0 - lost) / length
        # Slope of log(sinh(R) / R): coth R - 1 / R
        langevin = (1.0 + lost) / -np.expm1(-2.0 * length) - 1.0 / length
        turn = -product * sine / length
        bend = -(product * cosine + turn**2) / length
        first = products * langevin * turn
        second = products * ((1.0 - 2.0 * langevin / length) * turn**2 + langevin * bend)
        return products, first, second

    def lobes(self) -> tuple[ZonalLobe, ...]:
        """The K kernels as lobes to filter environments with."""
        return tuple(von_mises_fisher_lobe(kappa) for kappa in self.concentrations)

    def mixture(self, weights: Array) -> ZonalLobe:
        """A sum of kernels as a lobe to filter environments with.

        Parameters
        ----------
        weights : ndarray, shape (K,)
            Weights of the kernels; their sum is the lobe's integral.

        Returns
        -------
        ZonalLobe
            With its zonal coefficients in closed form.
        """
        kernels = self.lobes()

        def profile(lobe_angle: Array) -> Array:
            values: Array = self.values(np.sin(0.5 * lobe_angle) ** 2) @ weights
            return values

        def coefficients(degree: int) -> Array:
            total = np.zeros(degree + 1)
            for weight, kernel in zip(weights, kernels, strict=True):
                if weight != 0.0:
                    total += weight * zonal_coefficients(kernel, degree)
            return total

        sharpest = self.concentrations[int(np.flatnonzero(weights)[-1])] if np.any(weights) else BROADEST
        return ZonalLobe(profile, graded_knots(1.0 / np.sqrt(sharpest)), coefficients)


def octaves(sharpest: float) -> KernelBank:
    """The bank of fits: concentrations `BROADEST`, its double, and so on.

    Parameters
    ----------
    sharpest : float
        Concentration that the last kernel reaches, up to `SHARPEST`.
    """
    last = int(np.ceil(np.log2(np.clip(sharpest, BROADEST, SHARPEST) / BROADEST) - TIE))
    return KernelBank(tuple(float(kappa) for kappa in BROADEST * 2.0 ** np.arange(last + 1)))
