"""Numbers of any size and sign in 16 bits, with a relative error that is bounded."""

from dataclasses import dataclass

import numpy as np

from .conventions import Array, Indices

STEPS = 256
"""Codes to a natural logarithm: rounding changes large values by 1 / 900 (root mean square)."""

UNIT = 0.1
"""Of the values' mean size: what is smaller is rounded as if it had this size."""


@dataclass(frozen=True)
class Companded:
    """Values in steps that grow with them.

    Attributes
    ----------
    codes : ndarray of int32, shape of the values
        Within 16 bits with a sign for all values below 3e26 times their mean size.
    unit : float
        Above 0.
    """

    codes: Indices
    unit: float

    def values(self) -> Array:
        """The values, rounded, float64, in the shape of `codes`."""
        rounded: Array = self.unit * np.sinh(self.codes / STEPS)
        return rounded


def companded(values: Array) -> Companded:
    """Round values.

    Parameters
    ----------
    values : ndarray, any shape
        Finite.

    Returns
    -------
    Companded
        No value x is further from its own than (abs(x) + unit) / (2 * `STEPS`), but for terms of second
        order: 1 / 512 of x where x is large.

    Notes
    -----
    The code of x is asinh(x / unit): linear around 0, and a logarithm far from it.
    """
    unit = UNIT * float(np.abs(values).mean(dtype=np.float64)) or 1.0
    return Companded(np.rint(STEPS * np.arcsinh(values / unit)).astype(np.int32), unit)
