"""The best axes of one elevation: Levenberg-Marquardt over variable projection."""

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
    """Move axes, and the weights of taps, to the nearest least error.

    Parameters
    ----------
    projector : Projector
    lookups : Lookups
        Where to start.
    with_taps : bool
        Whether the taps' weights move too.
    tie : float
        Penalty on each squared radian by which axes move, and each squared unit by which taps do, relative to
        the error at the start or, where that is less, `_ENOUGH`: unknowns that matter little stay in place.

    Returns
    -------
    lookups : Lookups
    projection : Projection
        The projection of these lookups.
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
    """Changes of all angles, then of all taps."""
    return np.concatenate([(end.angles - start.angles).ravel(), (end.taps - start.taps).ravel()])


def _moved(lookups: Lookups, step: Array, non_negative: bool) -> Lookups:
    turn, change = np.split(step, 2)
    turn = np.clip(turn, -_LARGEST_TURN, _LARGEST_TURN).reshape(lookups.angles.shape)
    taps = lookups.taps + change.reshape(lookups.taps.shape)
    if non_negative:
        taps = np.maximum(taps, 0.0)
    # A factor of a lobe's taps is also one of its profile: it is fixed, or rounding alone would choose it
    return Lookups(lookups.angles + turn, taps / np.abs(taps).sum(axis=1, keepdims=True))
