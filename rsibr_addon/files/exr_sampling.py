"""Interpolation of subsampled channels."""

import numpy as np

from ..core.conventions import Array

TAPS = 6
"""Stored samples that make an interpolated one."""


def interpolated(samples: Array, axis: int, step: int, length: int) -> Array:
    """A sample at every place from one at every `step`-th, by polynomials.

    Parameters
    ----------
    samples : ndarray, any shape
        Samples along `axis` at 0, step, 2 step ...; beyond them, the last repeats.
    axis : int
    step : int
    length : int
        Length of the result along `axis`.

    Returns
    -------
    ndarray
        As `samples`, but for its length along `axis`. Stored samples are kept.
    """
    if step == 1:
        return samples
    places = np.arange(length)
    nearest, phase = places // step, (places % step) / step
    taps = np.arange(1 - TAPS // 2, 1 + TAPS // 2)
    # Lagrange's polynomials: each is 1 at its own tap and 0 at the others
    weights = [
        np.prod([(phase - other) / (tap - other) for other in taps if other != tap], axis=0) for tap in taps
    ]
    shape = [-1 if number == axis else 1 for number in range(samples.ndim)]
    total = np.zeros(1, np.float32)
    for tap, weight in zip(taps, weights, strict=True):
        place = np.clip(nearest + tap, 0, samples.shape[axis] - 1)
        total = total + samples.take(place, axis) * weight.astype(np.float32).reshape(shape)
    return total
