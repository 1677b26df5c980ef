"""Symmetric systems of blocks in which each block knows its two neighbours alone."""

from dataclasses import dataclass

import numpy as np

from ..conventions import Array


@dataclass(frozen=True)
class Tridiagonal:
    """Symmetric block tridiagonal matrices, of S blocks of M unknowns each.

    Attributes
    ----------
    diagonal : ndarray, shape (..., S, M, M)
    above : ndarray, shape (..., S - 1, M, M)
        Blocks right of the diagonal's; those below are their transposes.
    """

    diagonal: Array
    above: Array

    def __add__(self, other: "Tridiagonal") -> "Tridiagonal":
        return Tridiagonal(self.diagonal + other.diagonal, self.above + other.above)

    def __sub__(self, other: "Tridiagonal") -> "Tridiagonal":
        return Tridiagonal(self.diagonal - other.diagonal, self.above - other.above)

    def sum(self) -> "Tridiagonal":
        """The sum over the first axis."""
        return Tridiagonal(self.diagonal.sum(axis=0), self.above.sum(axis=0))

    def __mul__(self, factor: float) -> "Tridiagonal":
        """The matrix times a number."""
        return Tridiagonal(factor * self.diagonal, factor * self.above)

    def trace(self) -> Array:
        """Sum of the diagonal's elements, shape (...)."""
        trace: Array = np.trace(self.diagonal, axis1=-2, axis2=-1).sum(axis=-1)
        return trace

    def __matmul__(self, columns: Array) -> Array:
        """The matrix times Q columns of shape (..., S, M, Q)."""
        product: Array = self.diagonal @ columns
        product[..., :-1, :, :] += self.above @ columns[..., 1:, :, :]
        product[..., 1:, :, :] += np.swapaxes(self.above, -1, -2) @ columns[..., :-1, :, :]
        return product

    def solve(self, right: Array) -> Array:
        """The unknowns, by elimination from block to block.

        Parameters
        ----------
        right : ndarray, shape (..., S, M, Q)
            Q right sides.

        Returns
        -------
        ndarray, shape (..., S, M, Q)
            The matrix times it is `right`; the matrix must be positive definite.
        """
        blocks, size = self.diagonal.shape[-3:-1]
        rest, diagonal = right[..., 0, :, :], self.diagonal[..., 0, :, :]
        eliminated = []
        for block in range(blocks - 1):
            above = self.above[..., block, :, :]
            both = np.linalg.solve(diagonal, np.concatenate([above, rest], axis=-1))
            eliminated.append(both)
            passed = np.swapaxes(above, -1, -2) @ both
            diagonal = self.diagonal[..., block + 1, :, :] - passed[..., :size]
            rest = right[..., block + 1, :, :] - passed[..., size:]
        found = [np.linalg.solve(diagonal, rest)]
        for both in reversed(eliminated):
            found.append(both[..., size:] - both[..., :size] @ found[-1])
        solved: Array = np.stack(found[::-1], axis=-3)
        return solved
