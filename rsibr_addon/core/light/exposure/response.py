"""A camera's curve, from its pictures' numbers to exposure."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...conventions import Array, Indices
from ...errors import RangeError
from ..transfer_curve import linear_from_srgb

LEVELS = 256
"""Encoded values at which a curve is known; between them it is interpolated."""

MIDDLE = 128
"""The level at which recovered curves agree with sRGB's: their scale cannot be known."""

DARKEST = 12
"""Level up to which a value is more noise or fog than light, and would bend the curve's foot."""

SMOOTHNESS = 50.0
"""Weight of a curve's squared second differences over that of the photographs, level by level."""


@dataclass(frozen=True, eq=False)
class Response:
    """A camera's curve, for each colour.

    Attributes
    ----------
    log_exposure : ndarray, shape (256, 3)
        Natural logarithm of the exposure, radiance times time, that gives each level; never falls.
    """

    log_exposure: Array

    def logarithm(self, encoded: Array) -> Array:
        """Logarithm of the exposure that pixels got.

        Parameters
        ----------
        encoded : ndarray, shape (..., 3)
            Numbers of a picture's file, in [0, 1].

        Returns
        -------
        ndarray, shape (..., 3), float64
        """
        levels, exposure = np.arange(LEVELS) / (LEVELS - 1.0), np.exp(self.log_exposure)
        return np.log(
            np.stack([np.interp(encoded[..., i], levels, exposure[:, i]) for i in range(3)], axis=-1)
        )


def srgb_response() -> Response:
    """The curve of sRGB pictures, IEC 61966-2-1; level 0 stands for half of level 1."""
    return _response_of(linear_from_srgb(np.arange(LEVELS) / (LEVELS - 1.0)))


def linear_response() -> Response:
    """The curve of pictures that are proportional to exposure; level 0 stands for half of level 1."""
    return _response_of(np.arange(LEVELS) / (LEVELS - 1.0))


def recover_response(samples: Array, weights: Array, times: Sequence[float]) -> Response:
    """Find a camera's curve from photographs of one scene at several exposures.

    Parameters
    ----------
    samples : ndarray, shape (photographs, pixels, 3)
        The same points in each photograph, encoded, in [0, 1].
    weights : ndarray, shape of `samples`
        Confidence in each sample's exposure, in [0, 1]: `merge.certainty`.
    times : sequence of float, one for each photograph
        The photographs' exposures, in seconds or any other unit.

    Returns
    -------
    Response
        In units of `times`. Level 128 has sRGB's exposure in every colour, so that a grey of the photographs
        stays grey.

    Raises
    ------
    RangeError
        No pixel is between black and white in two photographs.

    Notes
    -----
    [Debevec1997] Eq. 3: minimise sum_ij w_ij (g(z_ij) - ln E_i - ln t_j)^2 + smoothness. For given g the best
    ln E_i is a weighted mean over the photographs j; with that put in, the problem is quadratic in the 256
    values of g alone, and its matrix a sum over pairs of photographs. So it can take any number of pixels,
    where the paper takes some fifty. Weights are w, the paper's w^2; the smoothness is the same at every
    level. Then g is made not to fall.
    """
    levels = np.rint(samples * (LEVELS - 1.0)).astype(np.intp)
    weights = np.where(levels > DARKEST, weights, 0.0)
    log_times = np.log(np.asarray(times, dtype=np.float64))
    curves = [_log_curve(levels[..., i], weights[..., i], log_times) for i in range(3)]
    return Response(np.stack(curves, axis=-1))


def _response_of(exposure: Array) -> Response:
    exposure = exposure.copy()
    exposure[0] = 0.5 * exposure[1]
    return Response(np.repeat(np.log(exposure)[:, None], 3, axis=1))


def _log_curve(levels: Indices, weights: Array, log_times: Array) -> Array:
    """The curve of one colour, shape (256,), from levels and weights of shape (photographs, pixels)."""
    matrix, right = _normal_equations(levels, weights, log_times)
    amount = np.trace(matrix)
    if not amount > 0.0:
        raise RangeError(
            "No part of the photographs is between black and white in two of them: take exposures that lie "
            "closer together, or that are neither all too long nor all too short."
        )
    bend = np.diff(np.eye(LEVELS), 2, axis=0)
    matrix += SMOOTHNESS * amount / LEVELS * bend.T @ bend
    # The scale is free: hold the middle where sRGB has it
    middle = float(np.log(linear_from_srgb(MIDDLE / (LEVELS - 1.0))))
    matrix[MIDDLE, MIDDLE] += amount
    right[MIDDLE] += amount * middle
    curve: Array = np.maximum.accumulate(np.linalg.solve(matrix, right))
    return curve


def _normal_equations(levels: Indices, weights: Array, log_times: Array) -> tuple[Array, Array]:
    """Matrix and right-hand side for the values of the curve, without ln E and without smoothness."""
    # A pixel that only one photograph tells of says nothing about the curve
    useful = np.count_nonzero(weights, axis=0) >= 2
    levels, weights = levels[:, useful], weights[:, useful]
    total = weights.sum(axis=0)
    mean_time = log_times @ weights / total
    right = np.zeros(LEVELS)
    matrix = np.zeros(LEVELS * LEVELS)
    for first, (level, weight) in enumerate(zip(levels, weights, strict=True)):
        right += np.bincount(level, weight * (log_times[first] - mean_time), LEVELS)
        matrix += np.bincount(level * (LEVELS + 1), weight, LEVELS * LEVELS)
        for other_level, other_weight in zip(levels, weights, strict=True):
            pair = level * LEVELS + other_level
            matrix -= np.bincount(pair, weight * other_weight / total, LEVELS * LEVELS)
    return matrix.reshape(LEVELS, LEVELS), right
