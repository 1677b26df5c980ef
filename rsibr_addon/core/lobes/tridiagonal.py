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

    def solve(self, right: Array) -> Array:
        """The unknowns, by elimination from block to block.

        Parameters
        ----------
        right : ndarray, shape (..., S, M)

        Returns
        -------
        ndarray, shape (..., S, M)
            The matrix times it is `right`; the matrix must be positive definite.
        """
        blocks = self.diagonal.shape[-3]
        rest, diagonal = right[..., 0, :], self.diagonal[..., 0, :, :]
        eliminated = []
        for block in range(blocks - 1):
            above = self.above[..., block, :, :]
            both = np.linalg.solve(diagonal, np.concatenate([above, rest[..., None]], axis=-1))
            eliminated.append(both)
            passed = np.swapaxes(above, -1, -2) @ both
            diagonal = self.diagonal[..., block + 1, :, :] - passed[..., :-1]
            rest = right[..., block + 1, :] - passed[..., -1]
        found = [np.linalg.solve(diagonal, rest[..., None])]
        for both in reversed(eliminated):
            found.append(both[..., -1:] - both[..., :-1] @ found[-1])
        solved: Array = np.stack(found[::-1], axis=-3)[..., 0]
        return solved

    def form(self, unknowns: Array) -> Array:
        """Unknowns times the matrix times unknowns, shape (...), of unknowns of shape (..., S, M)."""
        own = np.einsum("...sm,...smn,...sn->...", unknowns, self.diagonal, unknowns)
        beside = np.einsum("...sm,...smn,...sn->...", unknowns[..., :-1, :], self.above, unknowns[..., 1:, :])
        form: Array = own + 2.0 * beside
        return form
