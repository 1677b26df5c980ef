"""A family of lobes: the fits of every roughness and elevation, for all materials of one kind of reflection.

The kernels, their number and what they stand for are those of `fit`. A family's channels are not colours but
functions of which the reflectance of every such material is a sum, as GGX times powers of 1 - cos. So the
lobes of a fragment are found by its roughness and n.v, and its colours by a small product.
"""

from dataclasses import dataclass

import numpy as np

from ..conventions import Array, ArrayLike
from ..errors import RangeError, ShapeError
from .bank import KernelBank
from .fit import Fit

KERNELS = KernelBank((0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 64.0, 256.0, 1024.0, 4096.0, 16384.0, 65536.0))
"""Kernels of families: broad ones are cheap, and steps of 4 beyond them raise E by a few percent only."""


@dataclass(frozen=True, eq=False)
class Family:
    """J lobes at A widths and S elevations, for C functions.

    The function of channel c, times n.l, towards light l is about the sum over lobes and kernels of
    weights * kernel(l . axis), the axis from `fit.lobe_axes`. Between samples, weights and tilts are linear
    in log alpha and in mu = n.v; beyond the first and the last, the values of these hold.

    Attributes
    ----------
    alpha : ndarray, shape (A,)
        Widths, ascending, in (0, 1].
    mu : ndarray, shape (S,)
        Cosines of the view elevations, ascending, in (0, 1].
    bank : KernelBank
        K kernels.
    tilts : ndarray, shape (A, S, J)
        Offsets of the axes from the mirror direction, in the plane of incidence.
    weights : ndarray, shape (A, S, J, K, C)
        Weights of the kernels; signed.

    Raises
    ------
    ShapeError
        The arrays' shapes do not fit each other.
    RangeError
        A value is not finite, or widths or elevations do not ascend within (0, 1].
    """

    alpha: Array
    mu: Array
    bank: KernelBank
    tilts: Array
    weights: Array

    def __post_init__(self) -> None:
        grid = (len(self.alpha), len(self.mu))
        if self.tilts.shape[:2] != grid or self.weights.shape[:-1] != (*self.tilts.shape, len(self.bank)):
            raise ShapeError(
                f"A family's tilts {self.tilts.shape} and weights {self.weights.shape} do not belong to "
                f"{grid[0]} widths and {grid[1]} elevations: fit it anew."
            )
        for name in ("alpha", "mu"):
            values = getattr(self, name)
            if not len(values) or np.any(np.diff(values, prepend=0.0) <= 0.0) or values[-1] > 1.0:
                raise RangeError(f"{name} of a family does not ascend within (0, 1]: fit it anew.")
        if not (np.all(np.isfinite(self.tilts)) and np.all(np.isfinite(self.weights))):
            raise RangeError("A family holds values that are not finite: fit it anew.")

    @property
    def albedo(self) -> Array:
        """Integral over the sphere of each channel at each sample, shape (A, S, C)."""
        albedo: Array = self.weights.sum(axis=(2, 3))
        return albedo

    def at(self, table: Array, alpha: ArrayLike, mu: ArrayLike) -> Array:
        """A table of the family, interpolated.

        Parameters
        ----------
        table : ndarray, shape (A, S, *rest)
            `tilts`, `weights`, `albedo`, or any other over widths and elevations.
        alpha, mu : array_like, shapes (...,), broadcastable to each other

        Returns
        -------
        ndarray, shape (..., *rest)
        """
        alpha, mu = np.broadcast_arrays(np.asarray(alpha, np.float64), np.asarray(mu, np.float64))
        rest = [1] * (table.ndim - 2)
        row, by_row = _neighbours(np.log(self.alpha), np.log(np.maximum(alpha, self.alpha[0])))
        column, by_column = _neighbours(self.mu, mu)
        found = np.zeros((*alpha.shape, *table.shape[2:]))
        for number, of_row in ((row, 1.0 - by_row), (np.minimum(row + 1, len(self.alpha) - 1), by_row)):
            for other, of_column in (
                (column, 1.0 - by_column),
                (np.minimum(column + 1, len(self.mu) - 1), by_column),
            ):
                found += (of_row * of_column).reshape((*alpha.shape, *rest)) * table[number, other]
        return found

    def at_elevations(self, mu: Array) -> "Family":
        """The family at other elevations, interpolated.

        Parameters
        ----------
        mu : ndarray, shape (T,)
            Ascending, in (0, 1].
        """
        alpha = self.alpha[:, None]
        tilts, weights = (self.at(table, alpha, mu) for table in (self.tilts, self.weights))
        return Family(self.alpha, mu, self.bank, tilts, weights)

    def fit(self, alpha: float, coefficients: Array, brdf: str) -> Fit:
        """The lobes of one material.

        Parameters
        ----------
        alpha : float
            Its width.
        coefficients : ndarray, shape (C, 3)
            Its reflectance, in each channel of linear Rec. 709, as a sum of the family's functions.
        brdf : str
            Text of its model.
        """
        tilts = self.at(self.tilts, alpha, self.mu).T
        weights = np.moveaxis(self.at(self.weights, alpha, self.mu) @ coefficients, 0, 1)
        return Fit(
            brdf=brdf,
            method="joint",
            mu=self.mu,
            bank=self.bank,
            weights=weights,
            scale=np.ones((*tilts.shape, 3)),
            offsets=np.stack([tilts, np.zeros_like(tilts)], axis=-1)[:, :, None],
            taps=np.ones((*tilts.shape, 1)),
        )


def _neighbours(samples: Array, wanted: Array) -> tuple[Array, Array]:
    """The sample at or below each wanted value, and the share of the next one."""
    position = np.interp(wanted, samples, np.arange(len(samples)))
    below = np.minimum(position.astype(np.intp), max(len(samples) - 2, 0))
    return below, position - below
