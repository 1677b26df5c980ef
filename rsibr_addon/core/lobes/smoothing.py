"""Fits of noisy measurements: axes and profiles that change as evenly over the elevations as the data allow.

Each elevation of a measurement has an error of its own, and a fit follows it: highlights then wobble as a
view passes from one elevation to the next. So all elevations are solved together, with a penalty on the
distance of axes and profiles from the line between their neighbours', as in smoothing splines. The weight of
the penalty, its price, is the largest at which the error halfway between elevations, which no fit has seen,
is within `TOLERATED` of the least. Cross-validation, likewise, takes the simplest model within one standard
error.
"""

from collections.abc import Sequence

import numpy as np

from ..conventions import Array
from .projection import Lookups, Projector
from .target import TargetSlice

PRICES = (0.03, 0.1, 0.3, 1.0)
"""Prices of profiles' squared distance from the line, in units of the same squared error."""

AXES = 30.0
"""Factor of the price for axes, whose wobble a highlight shows first."""

TOLERATED = 1.05
"""Greatest error halfway between elevations, over the least."""


def lines(mu: Array) -> Array:
    """Distances of values, at every elevation but the ends, from the line between their neighbours'.

    Parameters
    ----------
    mu : ndarray, shape (S,)

    Returns
    -------
    ndarray, shape (max(S - 2, 0), S)
        Matrix that multiplies the values.
    """
    matrix = np.zeros((max(len(mu) - 2, 0), len(mu)))
    for row, (below, here, above) in enumerate(zip(mu, mu[1:], mu[2:], strict=False)):
        share = (here - below) / (above - below)
        matrix[row, row : row + 3] = share - 1.0, 1.0, -share
    return matrix


def smoothed_lookups(
    slices: Sequence[TargetSlice], lookups: Sequence[Lookups], price: float
) -> list[Lookups]:
    """Axes whose tilts, and taps whose weights, are nearer to lines over mu.

    Parameters
    ----------
    slices : sequence of TargetSlice
        S of them, in ascending order of elevation.
    lookups : sequence of Lookups
        At each.
    price : float
    """
    matrix = lines(np.array([target.mu for target in slices]))
    blend = np.linalg.inv(np.eye(len(slices)) + AXES * price * matrix.T @ matrix)
    sine = np.array([np.sin(target.theta) for target in slices])[:, None, None]
    theta = np.array([target.theta for target in slices])[:, None, None]
    # Tilts, as `fit.lobe_axes` counts them
    tilts = (theta - np.array([each.angles for each in lookups])) / sine
    angles = theta - np.tensordot(blend, tilts, 1) * sine
    taps = np.tensordot(blend, np.array([each.taps for each in lookups]), 1)
    return [Lookups(*both) for both in zip(angles, taps, strict=True)]


def smoothed_weights(
    projectors: Sequence[Projector], lookups: Sequence[Lookups], price: float
) -> list[Array]:
    """The best profiles at all elevations together.

    Parameters
    ----------
    projectors : sequence of Projector
        S of them, of one bank; lookups as those of `smoothed_lookups`, of J lobes.
    price : float
        Price of profiles' squared distance from the line between their neighbours', over the target's power.

    Returns
    -------
    list of ndarray, shape (J, K, 3)
        Weights of the kernels.
    """
    equations = [projector.equations(each) for projector, each in zip(projectors, lookups, strict=True)]
    slices, lobes = len(projectors), len(lookups[0].taps)
    size = len(equations[0][1])
    system = np.zeros((slices, size, slices, size))
    right = np.array([moments for _, moments in equations])
    for number, (own, _) in enumerate(equations):
        system[number, :, number] = own
    # Coefficients are in units of their own target's norm
    norm = np.sqrt([projector.target.power for projector in projectors])
    matrix = lines(np.array([projector.target.mu for projector in projectors]))
    matrix = matrix * norm / norm[1:-1, None]
    power = np.kron(np.eye(lobes), projectors[0].own)
    system += price * np.einsum("st,kl->sktl", matrix.T @ matrix, power)
    solved = np.linalg.solve(system.reshape(slices * size, -1), right.reshape(slices * size, 3))
    coefficients = solved.reshape(slices, lobes, -1, 3)
    return [projector.weights(each) for projector, each in zip(projectors, coefficients, strict=True)]
