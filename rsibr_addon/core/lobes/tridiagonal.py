"""Symmetric systems of blocks in which each block knows its two neighbours alone."""

from collections.abc import Iterable, Iterator
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
        *eliminated, (_, own, _) = self._eliminated(np.moveaxis(right, -3, 0))
        found = [own]
        for _, own, following in reversed(eliminated):
            found.append(own - following @ found[-1])
        solved: Array = np.stack(found[::-1], axis=-3)
        return solved

    def powers(self, right: Iterable[Array]) -> Array:
        """Scalar product of each right side with its unknowns, which need not be found for it.

        Parameters
        ----------
        right : iterable of ndarray, shapes (..., M, Q)
            The S blocks of Q right sides.

        Returns
        -------
        ndarray, shape (..., Q)
        """
        of_blocks = [np.sum(rest * own, axis=-2) for rest, own, _ in self._eliminated(right)]
        powers: Array = np.sum(of_blocks, axis=0)
        return powers

    def _eliminated(self, right: Iterable[Array]) -> Iterator[tuple[Array, Array, Array]]:
        """Eliminate one block after the other.

        Yields the block's right sides without what blocks before it say, the unknowns that these give, and
        how much of the next block's is to be taken from those: of the last block, nothing.
        """
        size = self.diagonal.shape[-1]
        from_before: Array = np.zeros((size, 1))
        diagonal = self.diagonal[..., 0, :, :]
        for block, of_block in enumerate(right):
            rest = of_block - from_before
            if block == self.diagonal.shape[-3] - 1:
                yield rest, np.linalg.solve(diagonal, rest), diagonal[..., :0]
                return
            above = self.above[..., block, :, :]
            both = np.linalg.solve(diagonal, np.concatenate([above, rest], axis=-1))
            yield rest, both[..., size:], both[..., :size]
            passed = np.swapaxes(above, -1, -2) @ both
            diagonal = self.diagonal[..., block + 1, :, :] - passed[..., :size]
            from_before = passed[..., size:]
