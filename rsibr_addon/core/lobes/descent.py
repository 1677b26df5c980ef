"""Down to the best axes of one elevation: Levenberg-Marquardt over variable projection."""

import numpy as np

from ..conventions import Array
from .projection import Lookups, Projection, Projector

_ITERATIONS, _TRIALS = 40, 7
_CONVERGED = 1e-5
_DAMPING = 1e-3
_LARGEST_TURN = 0.3
_FLATTEST = 1e-9


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
        Share of the error at the start that must be gained for every squared radian that an axis moves: axes
        on which next to nothing depends stay where they are.

    Returns
    -------
    lookups : Lookups
    projection : Projection
        Of these.
    """
    count = lookups.angles.size
    free = slice(None) if with_taps else slice(count)
    here, damping = projector.project(lookups), _DAMPING
    start, price = lookups.angles, tie * here.objective
    ties = np.diag(np.repeat([2.0 * price, 0.0], count))[free, free]

    def paid(lookups: Lookups) -> float:
        return price * float(np.sum((lookups.angles - start) ** 2))

    for _ in range(_ITERATIONS):
        gradient, hessian = here.gradient[free].copy(), here.hessian[free, free] + ties
        gradient[:count] += 2.0 * price * (lookups.angles - start).ravel()
        diagonal = np.maximum(hessian.diagonal(), _FLATTEST)
        for _ in range(_TRIALS):
            step = np.zeros(2 * count)
            step[free] = -np.linalg.solve(hessian + damping * np.diag(diagonal), gradient)
            moved = _moved(lookups, step, projector.non_negative)
            there = projector.project(moved)
            gain = here.objective + paid(lookups) - there.objective - paid(moved)
            if gain > 0.0:
                break
            damping *= 10.0
        else:
            break
        lookups, here, damping = moved, there, damping / 10.0
        if gain < _CONVERGED * here.objective:
            break
    return lookups, here


def _moved(lookups: Lookups, step: Array, non_negative: bool) -> Lookups:
    turn, change = np.split(step, 2)
    turn = np.clip(turn, -_LARGEST_TURN, _LARGEST_TURN).reshape(lookups.angles.shape)
    taps = lookups.taps + change.reshape(lookups.taps.shape)
    return Lookups(lookups.angles + turn, np.maximum(taps, 0.0) if non_negative else taps)
