"""One map of radiance from the photographs of a bracket."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ...conventions import Array
from ...errors import RangeError
from ...ties import first_greatest
from .motion import Motion, covers, looked_up, motion_between, pixel_points
from .response import Response, recover_response

SAMPLES = 40_000
"""Approximate number of points from which the camera's curve is recovered."""

GREEN = 1
"""Channel in which movement is looked for: it has the least noise, and in most cameras the most pixels."""

WHITE = 0.97
"""Encoded value above which a pixel may be saturated."""

BLACK = 2.0 / 255.0
"""Encoded value up to which a pixel is black: rounding alone is a quarter of it."""

ROUNDING = 1e-6
"""Rounding of encoded values, ample for single precision, so that 2 of 255 still is black."""

FALL = 0.02
"""Fall of the encoded value in a longer exposure from which on that pixel is not trusted."""

STILL = 0.1
"""[pixels] Movements below this are left alone: correcting them would blur."""


@dataclass(frozen=True, eq=False)
class Merged:
    """A picture of radiance from a bracket.

    Attributes
    ----------
    radiance : ndarray, shape (height, width, 3), float32
        In units of sRGB's white over those of the exposure times.
    saturated, black : float
        Shares of the pixels that are white in the shortest exposure, or black in the longest, in some colour;
        their radiance is too small, or too large.
    response : Response
    motions : tuple of Motion
        Movement of each photograph, from points of the picture to those of the photograph.
    """

    radiance: Array
    saturated: float
    black: float
    response: Response
    motions: tuple[Motion, ...]


def certainty(encoded: Array) -> Array:
    """Confidence in the exposures that a photograph's pixels tell.

    Parameters
    ----------
    encoded : ndarray, shape (height, width, 3)
        In [0, 1].

    Returns
    -------
    ndarray, shape of `encoded`, float64
        1 in the middle, falling to 0 at black, which is noise, and at white, which may be saturated.

    Notes
    -----
    [Debevec1997] Eq. 4. But a pixel beside a white one, among the eight around it, counts as white too:
    sensors, filters and resampling spread clipped light over the edge, so that the pixel is darker than the
    scene without looking so.
    """
    brightest = encoded
    for axis in (0, 1):
        padded = np.concatenate([brightest.take([0], axis), brightest, brightest.take([-1], axis)], axis)
        size = encoded.shape[axis]
        brightest = np.max([padded.take(range(i, i + size), axis) for i in range(3)], axis=0)
    hat: Array = 2.0 * np.minimum(encoded - BLACK, WHITE - brightest, dtype=np.float64)
    return np.clip(hat, 0.0, 1.0)


def merge_bracket(
    photographs: Sequence[Array],
    times: Sequence[float],
    response: Response | None = None,
    align: bool = True,
) -> Merged:
    """Merge photographs of one scene at several exposures.

    Parameters
    ----------
    photographs : sequence of ndarray, shape (height, width, 3)
        Encoded, in [0, 1], of one size.
    times : sequence of float
        The photographs' exposures, in seconds or any other unit, positive, the shortest first.
    response : Response, optional
        The camera's curve; recovered from the photographs where it is not given.
    align : bool
        Whether the camera may have moved between them.

    Returns
    -------
    Merged
        Aligned with the photograph that has most confidence.

    Raises
    ------
    RangeError
        There is only one photograph; exposures are not positive, not in order or all the same; no pixel is
        between black and white, in two photographs if the curve is to be recovered.

    Notes
    -----
    [Debevec1997] Eq. 6: the mean of the logarithms, weighted with `certainty`. Unlike a mean by photons, it
    is not dominated by the errors of the longest exposure: in pictures of 8 bits, wrong times cost more than
    noise. A pixel without confidence in any photograph takes the value of the shortest exposure if that is
    more than half of white, else that of the longest.
    """
    _check(photographs, times)
    weights = [certainty(photograph) for photograph in photographs]
    if not any(np.any(weight) for weight in weights):
        raise RangeError(
            "All pixels of the photographs are black or white: take exposures neither too long nor too short."
        )
    motions = _motions(photographs, weights) if align else [Motion()] * len(photographs)
    curve = response or _recovered(photographs, weights, times, motions)
    mean, amount = _mean(photographs, weights, times, motions, curve)
    unsure = amount < ROUNDING
    shortest, longest = _ends(photographs, motions)
    by_shortest = curve.logarithm(shortest) - np.log(times[0])
    by_longest = curve.logarithm(longest) - np.log(times[-1])
    rest = np.where(shortest > 0.5, by_shortest, by_longest)
    # Each colour's curve is extrapolated at its upper end: a lamp must not get a colour from this
    white = np.all(unsure & (shortest > WHITE), axis=-1, keepdims=True)
    rest = np.where(white, rest.mean(axis=-1, keepdims=True), rest)
    return Merged(
        np.exp(np.where(unsure, rest, mean)).astype(np.float32),
        float(np.mean(np.any(unsure & (shortest > WHITE), axis=-1))),
        float(np.mean(np.any(unsure & (longest < BLACK + ROUNDING), axis=-1))),
        curve,
        tuple(motions),
    )


def _check(photographs: Sequence[Array], times: Sequence[float]) -> None:
    if len(photographs) < 2:
        raise RangeError("One photograph is no bracket: give two or more at different exposures.")
    if not (np.all(np.isfinite(times)) and times[0] > 0.0 and np.all(np.diff(times) >= 0.0)):
        raise RangeError("Exposure times must be positive, and the photographs in their order.")
    if times[0] == times[-1]:
        raise RangeError("All photographs have the same exposure: give some that differ.")


def _motions(photographs: Sequence[Array], weights: Sequence[Array]) -> list[Motion]:
    """Movements of all photographs from the most confident one, composed of those from each to the next."""
    motions = [Motion()]
    for first, second in pairwise(photographs):
        motions.append(motion_between(first[..., GREEN], second[..., GREEN]).after(motions[-1]))
    middle = first_greatest(np.array([weight.sum() for weight in weights]))
    back = motions[middle].inverse()
    height, width = weights[0].shape[:2]
    from_middle = (motion.after(back) for motion in motions)
    return [motion if motion.most(width, height) > STILL else Motion() for motion in from_middle]


def _recovered(
    photographs: Sequence[Array], weights: Sequence[Array], times: Sequence[float], motions: Sequence[Motion]
) -> Response:
    """The camera's curve, from points on a grid."""
    height, width = photographs[0].shape[:2]
    stride = max(1, int(np.sqrt(height * width / SAMPLES)))
    points = pixel_points(width, height)[stride // 2 :: stride, stride // 2 :: stride].ravel()
    samples, certain = [], []
    brightest = np.zeros((len(points), 3))
    for photograph, weight, motion in zip(photographs, weights, motions, strict=True):
        there = motion.of(points)
        seen = looked_up(photograph, there)
        trusted = (seen > brightest - FALL) & covers(there, width, height)[:, None]
        samples.append(seen)
        certain.append(looked_up(weight, there) * trusted)
        brightest = np.maximum(brightest, seen)
    return recover_response(np.stack(samples), np.stack(certain), times)


def _mean(
    photographs: Sequence[Array],
    weights: Sequence[Array],
    times: Sequence[float],
    motions: Sequence[Motion],
    curve: Response,
) -> tuple[Array, Array]:
    """Weighted mean of the logarithms of radiance, and the sum of the weights."""
    total, amount, brightest = (np.zeros(photographs[0].shape) for _ in range(3))
    height, width = total.shape[:2]
    points = pixel_points(width, height)
    for photograph, weight, time, motion in zip(photographs, weights, times, motions, strict=True):
        logarithm = curve.logarithm(photograph) - np.log(time)
        channels = np.concatenate([weight * logarithm, weight, photograph], axis=-1)
        trusted = np.ones((height, width, 1), dtype=bool)
        if motion != Motion():
            there = motion.of(points)
            channels = looked_up(channels, there)
            trusted = covers(there, width, height)[..., None]
        weighted, weight, seen = np.split(channels, 3, axis=-1)
        trusted = trusted & (seen > brightest - FALL)
        total += weighted * trusted
        amount += weight * trusted
        brightest = np.maximum(brightest, seen)
    return total / np.where(amount > 0.0, amount, 1.0), amount


def _ends(photographs: Sequence[Array], motions: Sequence[Motion]) -> tuple[Array, Array]:
    """The shortest and the longest exposure at the picture's points."""
    height, width = photographs[0].shape[:2]
    points = pixel_points(width, height)
    shortest, longest = (looked_up(photographs[i], motions[i].of(points)) for i in (0, -1))
    return shortest, longest
