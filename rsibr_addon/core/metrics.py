"""Differences of a picture from its reference."""

import numpy as np

from .conventions import Array, ArrayLike
from .errors import RangeError
from .geometry.directions import dot


def relative_rmse(ours: ArrayLike, reference: ArrayLike, weight: ArrayLike) -> float:
    """Weighted root-mean-square error over the reference's own weighted root mean square.

    Parameters
    ----------
    ours, reference : array_like, shape (..., channels)
        Radiance.
    weight : array_like, shape (...,)
        Weight of each pixel, at least 0: for example its coverage.

    Returns
    -------
    float
        sqrt(sum w |ours - reference|^2 / sum w |reference|^2) over all pixels and channels: 0 for
        equal pictures, 1 for a black one. Pictures stacked into one array give their pooled error.

    Raises
    ------
    RangeError
        No pixel counts, or the reference is black wherever one does, so that nothing is relative to it.
    """
    reference = np.asarray(reference, dtype=np.float64)
    difference = np.asarray(ours, dtype=np.float64) - reference
    weight = np.asarray(weight, dtype=np.float64)
    power = float(np.sum(weight * dot(reference, reference)))
    _check_power(power, weight)
    return float(np.sqrt(np.sum(weight * dot(difference, difference)) / power))


def relative_rmse_beyond_noise(
    ours: ArrayLike, first: ArrayLike, second: ArrayLike, weight: ArrayLike
) -> float:
    """`relative_rmse` against a noisy reference as if it had no noise.

    Parameters
    ----------
    ours, first, second : array_like, shape (..., channels)
        Radiance; the last two are renders of the same with independent, unbiased noise.
    weight : array_like, shape (...,)

    Returns
    -------
    float
        sqrt(sum w (ours - first).(ours - second) / sum w first.second), at least 0.

    Raises
    ------
    RangeError
        No pixel counts, or the reference is black, or nothing but noise, wherever one does.

    Notes
    -----
    Independent noises multiply to 0 on average, so the product's mean is the squared error itself. Against
    the mean of both renders, the noise that it keeps would count as an error of ours.
    """
    first, second = np.asarray(first, dtype=np.float64), np.asarray(second, dtype=np.float64)
    ours, weight = np.asarray(ours, dtype=np.float64), np.asarray(weight, dtype=np.float64)
    power = float(np.sum(weight * dot(first, second)))
    _check_power(power, weight)
    squared_error = np.sum(weight * dot(ours - first, ours - second))
    return float(np.sqrt(np.maximum(squared_error / power, 0.0)))


def _check_power(power: float, weight: Array) -> None:
    if not np.any(weight):
        raise RangeError("No pixel counts, since all weights are 0: give pictures that show something.")
    if not power > 0.0:
        raise RangeError("A reference that is black all over has no relative error: light the scene.")


def unpremultiplied(rgba: Array) -> Array:
    """Mean radiance of the covered part of each pixel.

    Parameters
    ----------
    rgba : ndarray, shape (..., 4)
        Radiance times coverage, and coverage in [0, 1].

    Returns
    -------
    ndarray, shape (..., 3), float64
        Radiance; 0 where nothing is covered.
    """
    premultiplied, coverage = np.split(np.asarray(rgba, dtype=np.float64), [3], axis=-1)
    radiance: Array = np.divide(
        premultiplied, coverage, out=np.zeros_like(premultiplied), where=coverage > 0.0
    )
    return radiance
