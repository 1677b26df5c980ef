"""Where to capture a material next: the views that tell most of its lobes.

A texel is a linear equation of the lobes' weights. Its factors depend on the view and the light alone, so
that it is known what a view will tell before it is captured. Weights may differ from those of the likeness by
a share of these: that is their covariance before any view, and the normal matrix of the views gives the one
after them. Views that were left out say how large the share is. Of some directions all around, the next view
is the one that lowers the expected squared error of all of them most.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..conventions import Array
from ..geometry.geodesic import VERTEX_COUNTS, geodesic_sphere
from ..kinds.radiance_views.views import RadianceViews
from ..ties import first_greatest
from .captured_light import CapturedLight
from .captured_texels import captured_texels, equations_of
from .tridiagonal import Tridiagonal

TEXELS = 100
"""Texels that stand for a view, about; those that mirror suns are taken besides."""

PRICES = 10.0 ** np.arange(2, -10, -1)
"""Factors of a precision that are tried, in units of what the views tell."""

NEAREST = np.radians(9.0)
"""Least angle from a captured view to a next one [rad], half of that between 162 views."""


@dataclass(frozen=True, eq=False)
class Weighed:
    """What is known of the weights of one part's lobes before any view.

    Attributes
    ----------
    mu : ndarray, shape (S,)
    tilts : ndarray, shape (S, J)
        See `captured_texels.equations_of`.
    precision : Tridiagonal
        Inverse of their covariance, but for a factor: S blocks of J * K weights.
    variance : float
        Squared error of captured texels whose views were left out, the sum over them.
    """

    mu: Array
    tilts: Array
    precision: Tridiagonal
    variance: float


def next_views(
    view_dirs: Array, size: int, light: CapturedLight, parts: Sequence[Weighed], count: int
) -> Array:
    """The directions in which to capture next, one after another, the best first.

    Parameters
    ----------
    view_dirs : ndarray, shape (V, 3)
        Of the captured views.
    size : int
        Width and height of a view in texels.
    light : CapturedLight
    parts : sequence of Weighed
        Of the fit to the captured views.
    count : int

    Returns
    -------
    ndarray, shape (n, 3)
        n is less than `count` where captured views leave no room for more.
    """
    candidates = candidate_dirs(len(view_dirs) + count)
    told = [
        Candidates(known, equations_of_views(candidates, size, light, part))
        for part, known in zip(parts, _known(view_dirs, size, light, parts), strict=True)
    ]
    chosen = view_dirs
    for _ in range(count):
        near = _near(candidates, chosen)
        if near.all():
            break
        best = first_greatest(np.where(near, -np.inf, sum(each.falls() for each in told)))
        for each in told:
            each.see(best)
        chosen = np.concatenate([chosen, candidates[[best]]])
    return chosen[len(view_dirs) :]


@dataclass(frozen=True, eq=False)
class Comparison:
    """Captured views that are left out beside views that are new.

    Attributes
    ----------
    like_new : ndarray of bool, shape (V,)
        The captured views of which, left out, no more is expected to be wrong than of any new view.
    untested : ndarray, shape (n, 3)
        Directions of new views of which more is expected to be wrong than of any captured view left out.
    share : float
        Theirs of all new views.
    """

    like_new: NDArray[np.bool]
    untested: Array
    share: float


def compare_with_new(
    view_dirs: Array, size: int, light: CapturedLight, parts: Sequence[Weighed]
) -> Comparison:
    """What views that are left out tell of new ones, which may be easier to predict, or harder.

    Parameters
    ----------
    view_dirs, size, light, parts
        See `next_views`.
    """
    candidates = candidate_dirs(len(view_dirs))
    new_dirs = candidates[~_near(candidates, view_dirs)]
    if not len(new_dirs):
        return Comparison(np.ones(len(view_dirs), bool), new_dirs, 0.0)
    known = _known(view_dirs, size, light, parts)
    left_out = np.sum([each.left_out for each in known], axis=0)
    new = np.sum(
        [
            each.errors(equations_of_views(new_dirs, size, light, part))
            for part, each in zip(parts, known, strict=True)
        ],
        axis=0,
    )
    # One view is like a new one at least
    like_new = left_out <= max(new.max(), left_out.min())
    untested = new > left_out.max()
    return Comparison(like_new, new_dirs[untested], float(np.mean(untested)))


def _near(candidates: Array, view_dirs: Array) -> NDArray[np.bool]:
    """Which candidates are not new, shape (n,)."""
    near: NDArray[np.bool] = np.max(candidates @ view_dirs.T, axis=1) > np.cos(NEAREST)
    return near


def _known(view_dirs: Array, size: int, light: CapturedLight, parts: Sequence[Weighed]) -> list["Known"]:
    """What the captured views tell of each part."""
    return [
        Known(part, equations_of_views(view_dirs, size, light, part), 0.25 * np.pi * size**2)
        for part in parts
    ]


def candidate_dirs(views: int) -> Array:
    """Directions among which a next view is sought, shape (n, 3): about twice as many as `views` at least."""
    enough = next((count for count in VERTEX_COUNTS if count >= 2 * views), VERTEX_COUNTS[-1])
    return geodesic_sphere(enough).vertices


def equations_of_views(view_dirs: Array, size: int, light: CapturedLight, part: Weighed) -> list[Array]:
    """The equations of each of some views, shapes (S, J * K, N): the mean of those of all channels.

    Parameters
    ----------
    view_dirs, size, light
        See `next_views`.
    part : Weighed
    """
    black = np.broadcast_to(np.float32(0.0), (len(view_dirs), size, size, 3))
    views = RadianceViews(black, black, view_dirs=view_dirs)
    texels = captured_texels(views, len(view_dirs), TEXELS * len(view_dirs), light.suns.direction)
    equations = equations_of(texels, light, part.mu, part.tilts)
    both = np.sqrt(texels.stands_for)[:, None, None] * equations.rows.mean(axis=-1)
    columns: list[Array] = []
    for view in range(len(view_dirs)):
        own = np.flatnonzero(texels.view == view)
        every = np.zeros((len(part.mu), both.shape[-1], len(own)))
        for above in range(2):
            every[equations.below[own] + above, :, np.arange(len(own))] = both[own, above]
        columns.append(every)
    return columns


class Known:
    """What captured views tell of one part's weights.

    A texel's equation holds weights of two neighbouring elevations, as a step of the precision does. So
    systems are block tridiagonal, and no covariance of all weights is needed: only that of some texels.

    Parameters
    ----------
    part : Weighed
    captured : sequence of ndarray, shapes (S, J * K, N)
        Equations of the captured views: see `equations_of_views`.
    texels : float
        How many texels a view has.

    Attributes
    ----------
    variance : float
        Squared error that counts as 1 in a texel's equation.
    precision : Tridiagonal
        Inverse of the weights' covariance before any view.
    system : Tridiagonal
        The same after the captured views.
    left_out : ndarray, shape (captured,)
        Expected squared error of each captured view, were it left out: the sum over its texels.
    """

    def __init__(self, part: Weighed, captured: Sequence[Array], texels: float) -> None:
        self.variance = part.variance / (texels * len(captured))
        told = [_told(columns) for columns in captured]
        every = _sum(told)
        unit, tested = float(every.trace() / part.precision.trace()), -np.inf
        for price in PRICES:
            precision = part.precision * (price * unit)
            left_out = np.array(
                [
                    _error(every - own + precision, columns)
                    for own, columns in zip(told, captured, strict=True)
                ]
            )
            # The lower the price, the more the weights vary, and the more is wrong: but for rounding, where
            # views tell all
            if left_out.sum() < tested:
                break
            tested = left_out.sum()
            self.precision, self.left_out = precision, self.variance * left_out
            # Weights that vary by so much explain all of the error of views left out
            if tested >= texels * len(captured):
                break
        self.system = every + self.precision

    def errors(self, views: Sequence[Array]) -> Array:
        """Expected squared error of each of V new views, the sum over its texels, shape (V,).

        Parameters
        ----------
        views : sequence of ndarray, shapes (S, J * K, N)
            Their equations.
        """
        blocks = (np.concatenate(of_block, axis=-1) for of_block in zip(*views, strict=True))
        first = np.cumsum([0, *(columns.shape[-1] for columns in views[:-1])])
        errors: Array = self.variance * np.add.reduceat(self.system.powers(blocks), first)
        return errors


class Candidates:
    """What views that may follow would tell of one part's weights, besides what is known.

    The covariance of the texels of each is kept, and what it lowers.

    Parameters
    ----------
    known : Known
    candidates : sequence of ndarray, shapes (S, J * K, N)
        Their equations.
    """

    def __init__(self, known: Known, candidates: Sequence[Array]) -> None:
        self._candidates, self._variance, self._system = candidates, known.variance, known.system
        self._wanted = _sum([_told(columns) for columns in candidates])
        self._covariances: list[Array] = []
        self._spreads: list[Array] = []
        for columns in candidates:
            solved = self._system.solve(columns)
            self._covariances.append(_products(columns, solved))
            self._spreads.append(_products(solved, self._wanted @ solved))

    def falls(self) -> Array:
        """By how much each of the V candidates would lower the expected squared error of all, shape (V,)."""
        pairs = zip(self._covariances, self._spreads, strict=True)
        falls = [np.trace(np.linalg.solve(_with_noise(covariance), spread)) for covariance, spread in pairs]
        return self._variance * np.array(falls)

    def see(self, candidate: int) -> None:
        """Count one of the candidates as captured."""
        columns = self._candidates[candidate]
        # The covariance of weights falls by `fall` times its transpose
        root = np.linalg.cholesky(_with_noise(self._covariances[candidate]))
        fall = self._system.solve(columns) @ np.linalg.inv(root).T
        wanted = self._wanted @ fall
        spread, both = self._system.solve(wanted), _products(fall, wanted)
        for number, others in enumerate(self._candidates):
            of_fall, of_spread = _products(others, fall), _products(others, spread)
            self._covariances[number] -= of_fall @ of_fall.T
            crossed = of_spread @ of_fall.T
            self._spreads[number] += of_fall @ both @ of_fall.T - crossed - crossed.T
        self._system += _told(columns)


def _products(left: Array, right: Array) -> Array:
    """Scalar products of columns of shapes (S, M, N) and (S, M, Q), shape (N, Q)."""
    return np.tensordot(left, right, axes=((0, 1), (0, 1)))


def _error(system: Tridiagonal, columns: Array) -> float:
    """Expected squared error of a view, in units of that of a texel, where others make a system."""
    return float(system.powers(columns).sum())


def _told(columns: Array) -> Tridiagonal:
    """Normal matrix of a view's equations."""
    return Tridiagonal(columns @ columns.swapaxes(1, 2), columns[:-1] @ columns[1:].swapaxes(1, 2))


def _sum(systems: Sequence[Tridiagonal]) -> Tridiagonal:
    return sum(systems[1:], systems[0])


def _with_noise(covariance: Array) -> Array:
    """Covariance of texels with their noise, which is 1."""
    noisy: Array = covariance + np.eye(len(covariance))
    return noisy
