"""Down to the best axes of one elevation: Levenberg-Marquardt over variable projection."""

import numpy as np

from ..conventions import Array
from .projection import Lookups, Projection, Projector

_ITERATIONS, _TRIALS = 40, 7
_CONVERGED = 1e-5
_DAMPING = 1e-3
_LARGEST_TURN = 0.3
_FLATTEST = 1e-9
_ENOUGH = 1e-4


def descend(
    projector: Projector, lookups: Lookups, with_taps: bool, tie: float = 0.0
) -> tuple[Lookups, Projection]:
    """Move axes, and the weights of taps, to where the error is least nearby.

    Parameters
    ----------
    projector : Projector
    lookups : Lookups
        Where to start.
    with_taps : bool
        Whether the taps' weights move too.
    tie : float
        What must be gained for every squared radian that axes move, and every squared unit that taps do,
        over the error at the start or, where that is less, `_ENOUGH`: what little depends on stays as it is.

    Returns
    -------
    lookups : Lookups
    projection : Projection
        Of these.
    """
    count = lookups.angles.size
    free = slice(None) if with_taps else slice(count)
    here, damping = projector.project(lookups), _DAMPING
    start = lookups
    price = tie * max(here.objective, _ENOUGH)

    for _ in range(_ITERATIONS):
        gradient = (here.gradient + 2.0 * price * _change(start, lookups))[free]
        hessian = here.hessian[free, free] + 2.0 * price * np.eye(len(gradient))
        diagonal = np.maximum(hessian.diagonal(), _FLATTEST)
        for _ in range(_TRIALS):
            step = np.zeros(2 * count)
            step[free] = -np.linalg.solve(hessian + damping * np.diag(diagonal), gradient)
            moved = _moved(lookups, step, projector.non_negative)
            there = projector.project(moved)
            paid = price * np.sum(_change(start, moved) ** 2 - _change(start, lookups) ** 2)
            gain = here.objective - there.objective - paid
            if gain > 0.0:
                break
            damping *= 10.0
        else:
            break
        lookups, here, damping = moved, there, damping / 10.0
        if gain < _CONVERGED * here.objective:
            break
    return lookups, here


def _change(start: Lookups, end: Lookups) -> Array:
    """Of all angles, then of all taps."""
    return np.concatenate([(end.angles - start.angles).ravel(), (end.taps - start.taps).ravel()])


def _moved(lookups: Lookups, step: Array, non_negative: bool) -> Lookups:
    turn, change = np.split(step, 2)
    turn = np.clip(turn, -_LARGEST_TURN, _LARGEST_TURN).reshape(lookups.angles.shape)
    taps = lookups.taps + change.reshape(lookups.taps.shape)
    if non_negative:
        taps = np.maximum(taps, 0.0)
    # A factor of a lobe's taps is one of its profile: fixed, or rounding alone would choose it
    return Lookups(lookups.angles + turn, taps / np.abs(taps).sum(axis=1, keepdims=True))
