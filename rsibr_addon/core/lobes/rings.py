"""Sheen as a sum of few lobes about the normal: a cosine, and rings of light from the horizon.

Of a linearly transformed cosine what lies to one side is left out: its mean over azimuth is what a few
maps by the normal can show. A ring is such a cosine itself, with b = 0.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np

from ..brdf.sheen import Sheen, transformed_cosine
from ..conventions import Array, ArrayLike
from ..errors import RangeError, ShapeError
from ..progress import Progress, Steps
from .nonnegative import nonnegative_inverse

WIDTHS = (0.1, 0.25, 0.55)
"""The a of each ring's transform; the cosine's is 1."""

ROUGHNESSES, ELEVATIONS = 32, 32
"""Samples of the table that comes with us; Cycles' own has as many."""

_NODES, _AZIMUTHS = 200, 32
_ALBEDO_COUNTS = 1e3


@dataclass(frozen=True, eq=False)
class SheenTable:
    """Sheen of all roughnesses and views as weights of 1 + R lobes about the normal.

    Between samples weights are linear; views lower than the first sample have its weights.

    Attributes
    ----------
    weights : ndarray, shape (N, S, 1 + R)
        Of the cosine and of each of `WIDTHS`, not negative, of lobes that integrate to 1: of N roughnesses
        from 0 to 1, and of S elevations in the middles of equal steps of n.v.

    Raises
    ------
    ShapeError
        It has not as many weights as there are lobes.
    RangeError
        A weight is negative or not finite.
    """

    weights: Array

    def __post_init__(self) -> None:
        if self.weights.ndim != 3 or self.weights.shape[2] != 1 + len(WIDTHS):
            raise ShapeError(f"A table of sheen of shape {self.weights.shape} is none of ours: fit it anew.")
        if not (np.all(np.isfinite(self.weights)) and np.all(self.weights >= 0.0)):
            raise RangeError("A table of sheen holds weights that are negative or not finite: fit it anew.")

    def at(self, roughness: ArrayLike, mu: ArrayLike) -> Array:
        """Weights, shape (..., 1 + R); their sum is the directional albedo.

        Parameters
        ----------
        roughness, mu : array_like, shapes (...,), broadcastable to each other
        """
        count, rows = self.weights.shape[:2]
        roughness, mu = np.broadcast_arrays(np.asarray(roughness, np.float64), np.asarray(mu, np.float64))
        x = np.clip(roughness, 0.0, 1.0) * (count - 1)
        y = np.clip(mu * rows - 0.5, 0.0, rows - 1)
        column, row = (
            np.minimum(place.astype(np.intp), most) for place, most in ((x, count - 2), (y, rows - 2))
        )
        of_x, of_y = (x - column)[..., None], (y - row)[..., None]
        low, high = (
            (1.0 - of_y) * self.weights[number, row] + of_y * self.weights[number, row + 1]
            for number in (column, column + 1)
        )
        found: Array = (1.0 - of_x) * low + of_x * high
        return found


def elevations(count: int = ELEVATIONS) -> Array:
    """n.v of a table's samples, shape (count,)."""
    return (np.arange(count) + 0.5) / count


def fit_sheen(sheen_of: Callable[[float, Array], Sheen], count: int = ROUGHNESSES) -> Steps[SheenTable]:
    """A table of a sheen.

    Parameters
    ----------
    sheen_of : callable
        From a roughness and cosines of views, shape (N,), to the sheen.
    count : int
        Number N of roughnesses.
    """
    rows = []
    for number, roughness in enumerate(np.linspace(0.0, 1.0, count).tolist()):
        yield Progress(number, count, f"sheen of roughness {roughness:.2f}")
        rows.append(ring_weights(sheen_of(roughness, elevations())))
    return SheenTable(np.array(rows))


def ring_weights(sheen: Sheen) -> Array:
    """Weights of lobes about the normal with the sheen's albedo, nearest to it, shape (S, 1 + R)."""
    height, solid, lobes = _lobes()
    counted = np.concatenate([lobes * np.sqrt(solid)[:, None], np.full((1, lobes.shape[1]), _ALBEDO_COUNTS)])
    weights = np.zeros((len(sheen.mu), lobes.shape[1]))
    for number, (a, b, albedo) in enumerate(zip(sheen.a, sheen.b, sheen.albedo, strict=True)):
        wanted = np.append(_around(height, a, b).mean(axis=1) * np.sqrt(solid), _ALBEDO_COUNTS)
        right = counted.T @ wanted
        weights[number] = albedo * (nonnegative_inverse(counted.T @ counted, right) @ right)
    return weights


def ring_errors(sheen: Sheen, weights: Array) -> Array:
    """Relative root-mean-square errors of weights over the hemisphere, shape (S,).

    Parameters
    ----------
    sheen : Sheen
    weights : ndarray, shape (S, 1 + R)
    """
    height, solid, lobes = _lobes()
    errors = []
    for a, b, albedo, row in zip(sheen.a, sheen.b, sheen.albedo, weights, strict=True):
        exact = albedo * _around(height, a, b)
        power = solid @ np.mean(exact**2, axis=1)
        wrong = solid @ np.mean((exact - (lobes @ row)[:, None]) ** 2, axis=1)
        errors.append(float(np.sqrt(wrong / np.maximum(power, 1e-30))))
    return np.array(errors)


def ring(cosine: ArrayLike, a: float) -> Array:
    """A lobe about the normal, of a cosine to it, which integrates to 1: see `transformed_cosine`.

    Parameters
    ----------
    cosine : array_like, shape (...,)
        Between normal and light, in [-1, 1].
    a : float
        Width, above 0.

    Returns
    -------
    ndarray, shape (...,)
        [1/sr]; 0 below the horizon.
    """
    cosine = np.asarray(cosine, np.float64)
    return transformed_cosine(np.sqrt(np.maximum(1.0 - cosine**2, 0.0)), 0.0, cosine, a)


def _around(height: Array, a: float, b: float) -> Array:
    """A transformed cosine at some n.l, at even azimuths, shape (N, azimuths)."""
    azimuth = 2.0 * np.pi * (np.arange(_AZIMUTHS) + 0.5) / _AZIMUTHS
    radius = np.sqrt(1.0 - height**2)[:, None]
    return transformed_cosine(radius * np.cos(azimuth), radius * np.sin(azimuth), height[:, None], a, b)


@cache
def _lobes() -> tuple[Array, Array, Array]:
    """n.l, denser near the horizon, the solid angles [sr] of these, and all lobes' values there."""
    node, weight = np.polynomial.legendre.leggauss(_NODES)
    root = 0.5 * (node + 1.0)
    height = root**2
    lobes = np.stack([ring(height, a) for a in (1.0, *WIDTHS)], axis=-1)
    return height, 2.0 * np.pi * weight * root, lobes
