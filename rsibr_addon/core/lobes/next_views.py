"""Where to capture a material next: the views that tell most of its lobes.

A texel is a linear equation of the lobes' weights. Its factors depend on the view and the light alone, so
that it is known what a view will tell before it is captured. Weights may differ from those of the likeness by
a share of these: that is their covariance before any view, and the normal matrix of the views gives the one
after them. Views that were left out say how large the share is. Of some directions all around, the next view
is the one that lowers the expected squared error of all of them most.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

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
    known = _known(view_dirs, candidates, size, light, parts)
    chosen = view_dirs
    for _ in range(count):
        near = _near(candidates, chosen)
        if near.all():
            break
        best = first_greatest(np.where(near, -np.inf, sum(each.falls() for each in known)))
        for each in known:
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
    known = _known(view_dirs, new_dirs, size, light, parts)
    left_out = np.sum([each.left_out for each in known], axis=0)
    new = np.sum([each.errors() for each in known], axis=0)
    # One view is like a new one at least
    like_new = left_out <= max(new.max(), left_out.min())
    untested = new > left_out.max()
    return Comparison(like_new, new_dirs[untested], float(np.mean(untested)))


def _near(candidates: Array, view_dirs: Array) -> NDArray[np.bool]:
    """Which candidates are not new, shape (n,)."""
    near: NDArray[np.bool] = np.max(candidates @ view_dirs.T, axis=1) > np.cos(NEAREST)
    return near


def _known(
    view_dirs: Array, candidates: Array, size: int, light: CapturedLight, parts: Sequence[Weighed]
) -> list["Known"]:
    """What views of some directions tell of views of others, for each part."""
    return [
        Known(
            part,
            equations_of_views(view_dirs, size, light, part),
            equations_of_views(candidates, size, light, part),
            0.25 * np.pi * size**2,
        )
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
    texels = captured_texels(views, len(view_dirs), TEXELS * len(view_dirs), light.sun_dir)
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
    """What views tell of one part's weights.

    A texel's equation holds weights of two neighbouring elevations, as a step of the precision does. So
    systems are block tridiagonal, and no covariance of all weights is needed: only that of the texels of
    each candidate, and what it lowers.

    Parameters
    ----------
    part : Weighed
    captured, candidates : sequence of ndarray, shapes (S, J * K, N)
        Equations of the captured views, and of those that may follow: see `equations_of_views`.
    texels : float
        How many texels a view has.

    Attributes
    ----------
    precision : Tridiagonal
        Inverse of the weights' covariance before any view.
    left_out : ndarray, shape (captured,)
        Expected squared error of each captured view, were it left out: the sum over its texels.
    """

    def __init__(
        self, part: Weighed, captured: Sequence[Array], candidates: Sequence[Array], texels: float
    ) -> None:
        self._candidates, self._variance = candidates, part.variance / (texels * len(captured))
        told = _told(captured)
        unit, tested = float(told.trace() / part.precision.trace()), -np.inf
        for price in PRICES:
            precision = part.precision * (price * unit)
            system = told + precision
            left_out = np.array(
                [_left_out(_products(columns, system.solve(columns))) for columns in captured]
            )
            # The lower the price, the more the weights vary, and the more is wrong: but for rounding, where
            # views tell all
            if left_out.sum() < tested:
                break
            tested = left_out.sum()
            self.precision, self._system, self.left_out = precision, system, self._variance * left_out
            # Weights that vary by so much explain all of the error of views left out
            if tested >= texels * len(captured):
                break
        self._covariances = [_products(columns, self._system.solve(columns)) for columns in candidates]

    @cached_property
    def _wanted(self) -> Tridiagonal:
        return _told(self._candidates)

    @cached_property
    def _spreads(self) -> list[Array]:
        solved = [self._system.solve(columns) for columns in self._candidates]
        return [_products(columns, self._wanted @ columns) for columns in solved]

    def errors(self) -> Array:
        """Expected squared error of each of the V candidates, the sum over its texels, shape (V,)."""
        return self._variance * np.array([np.trace(covariance) for covariance in self._covariances])

    def falls(self) -> Array:
        """By how much each of the V candidates would lower the sum of `errors`, shape (V,)."""
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
        self._system += _told([columns])


def _products(left: Array, right: Array) -> Array:
    """Scalar products of columns of shapes (S, M, N) and (S, M, Q), shape (N, Q)."""
    return np.tensordot(left, right, axes=((0, 1), (0, 1)))


def _told(views: Sequence[Array]) -> Tridiagonal:
    """Normal matrix of the equations of some views."""
    told = [
        Tridiagonal(columns @ columns.swapaxes(1, 2), columns[:-1] @ columns[1:].swapaxes(1, 2))
        for columns in views
    ]
    return sum(told[1:], told[0])


def _left_out(covariance: Array) -> float:
    """Expected squared error of a captured view, were it left out, in units of that of a texel."""
    return float(np.trace(np.linalg.solve(np.eye(len(covariance)) - covariance, covariance)))


def _with_noise(covariance: Array) -> Array:
    """Covariance of texels with their noise, which is 1."""
    noisy: Array = covariance + np.eye(len(covariance))
    return noisy
