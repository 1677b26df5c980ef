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

from ..conventions import Array
from ..geometry.geodesic import VERTEX_COUNTS, geodesic_sphere
from ..kinds.radiance_views.views import RadianceViews
from ..ties import first_greatest
from .captured_light import CapturedLight
from .captured_texels import captured_texels, equations_of

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
    precision : ndarray, shape (S * J * K, S * J * K)
        Inverse of their covariance, but for a factor.
    variance : float
        Squared error of captured texels whose views were left out, the sum over them.
    """

    mu: Array
    tilts: Array
    precision: Array
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
    known = [
        Known(
            part,
            rows_of_views(view_dirs, size, light, part),
            rows_of_views(candidates, size, light, part),
            0.25 * np.pi * size**2,
        )
        for part in parts
    ]
    chosen = view_dirs
    for _ in range(count):
        near = np.max(candidates @ chosen.T, axis=1) > np.cos(NEAREST)
        if near.all():
            break
        best = first_greatest(np.where(near, -np.inf, sum(each.falls() for each in known)))
        for each in known:
            each.see(best)
        chosen = np.concatenate([chosen, candidates[[best]]])
    return chosen[len(view_dirs) :]


def candidate_dirs(views: int) -> Array:
    """Directions among which a next view is sought, shape (n, 3): about twice as many as `views` at least."""
    enough = next((count for count in VERTEX_COUNTS if count >= 2 * views), VERTEX_COUNTS[-1])
    return geodesic_sphere(enough).vertices


def rows_of_views(view_dirs: Array, size: int, light: CapturedLight, part: Weighed) -> list[Array]:
    """The equations of each of some views, shapes (N, S * J * K): the mean of those of all channels.

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
    rows: list[Array] = []
    for view in range(len(view_dirs)):
        own = np.flatnonzero(texels.view == view)
        every = np.zeros((len(own), len(part.mu), both.shape[-1]))
        for above in range(2):
            every[np.arange(len(own)), equations.below[own] + above] = both[own, above]
        rows.append(every.reshape(len(own), -1))
    return rows


class Known:
    """What views tell of one part's weights.

    Parameters
    ----------
    part : Weighed
    captured, candidates : sequence of ndarray, shapes (N, S * J * K)
        Equations of the captured views, and of those that may follow: see `rows_of_views`.
    texels : float
        How many texels a view has.
    """

    def __init__(
        self, part: Weighed, captured: Sequence[Array], candidates: Sequence[Array], texels: float
    ) -> None:
        self._candidates, self._variance = candidates, part.variance / (texels * len(captured))
        self._seen = sum((rows.T @ rows for rows in candidates), np.zeros_like(part.precision))
        told = sum((rows.T @ rows for rows in captured), np.zeros_like(part.precision))
        unit = np.trace(told) / np.trace(part.precision)
        for price in PRICES:
            self.precision = price * unit * part.precision
            self._covariance = np.linalg.inv(self.precision + told)
            # Weights that vary by so much explain all of the error of views left out
            if sum(map(self._left_out, captured)) >= texels * len(captured):
                break

    @property
    def expected(self) -> float:
        """Expected squared error of all candidates together, the sum over their texels."""
        return self._variance * float(np.sum(self._covariance * self._seen))

    def falls(self) -> Array:
        """By how much each of the V candidates would lower `expected`, shape (V,)."""
        spread = self._covariance @ self._seen @ self._covariance
        falls = [
            np.trace(np.linalg.solve(self._with_noise(rows), rows @ spread @ rows.T))
            for rows in self._candidates
        ]
        return self._variance * np.array(falls)

    def see(self, candidate: int) -> None:
        """Count one of the candidates as captured."""
        rows = self._candidates[candidate]
        told = rows @ self._covariance
        self._covariance = self._covariance - told.T @ np.linalg.solve(self._with_noise(rows), told)

    def _left_out(self, rows: Array) -> float:
        """Expected squared error of a captured view, were it left out, in units of that of a texel."""
        covariance = rows @ self._covariance @ rows.T
        return float(np.trace(np.linalg.solve(np.eye(len(rows)) - covariance, covariance)))

    def _with_noise(self, rows: Array) -> Array:
        """Covariance of texels with their noise, which is 1."""
        covariance: Array = rows @ self._covariance @ rows.T + np.eye(len(rows))
        return covariance
