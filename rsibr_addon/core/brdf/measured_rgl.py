"""Reflectance from the RGL database: goniophotometer data on a grid that follows the material's lobe."""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ..conventions import Array, Indices
from ..errors import ShapeError
from .model import Brdf, Geometry


@dataclass(frozen=True, eq=False)
class MeasuredRgl(Brdf):
    """An isotropic material of the database, in RGB.

    Half vectors are warped to the unit square so that the normals which the view sees are spread evenly.
    There the measurement, divided by the density of a light direction sampled in this way, is smooth. The
    model is as reciprocal as the data: measurements with light and view swapped may differ. The product with
    n.l is finite at the horizon; the quotient that a call returns is not.

    Attributes
    ----------
    theta_v : ndarray, shape (T,), float64
        Angles of the measured views from the normal [radians], increasing.
    sigma, ndf : ndarray, shape (S,), float64
        Projected area and density [1/sr] of the microfacets, at angles (pi/2) u^2, u even over [0, 1].
    vndf : ndarray, shape (T, Y, X), float64
        Density of visible normals in the unit square of azimuth (Y: a full turn, the view's own at 1/2)
        and u (X).
    weight : ndarray, shape (T, 3, H, W), float64
        Measurement over the density of the light direction, at even steps of the warped square; at least 0.
    spec : str
        The text that stands for it, `rgl:path=satin.bsdf` for example.

    Raises
    ------
    ShapeError
        The arrays do not fit together.

    Notes
    -----
    [Dupuy2018]. The direction that the measurement keeps fixed is taken as the view, so that a slice is one
    view's lobe.
    """

    theta_v: Array
    sigma: Array
    ndf: Array
    vndf: Array
    weight: Array
    spec: str

    def __post_init__(self) -> None:
        views = self.theta_v.size
        grids = self.vndf.ndim == 3 and self.weight.ndim == 4 and self.weight.shape[1] == 3
        if not grids or not views == self.vndf.shape[0] == self.weight.shape[0]:
            raise ShapeError(f"{views} views, but grids {self.vndf.shape} and {self.weight.shape}")
        if self.sigma.ndim != 1 or self.sigma.shape != self.ndf.shape:
            raise ShapeError(f"microfacets of shapes {self.sigma.shape} and {self.ndf.shape}")
        if min(*self.vndf.shape[1:], *self.weight.shape[2:], self.sigma.size) < 2:
            raise ShapeError("a grid of less than two steps")
        if not np.all(np.diff(self.theta_v) > 0.0):
            raise ShapeError("views whose angles do not increase")

    def above_horizon(self, geometry: Geometry) -> Array:
        """See `Brdf`."""
        half_dir, view_dir = geometry.half_dir, geometry.view_dir
        u_half = _u_from_angle(np.arctan2(np.sqrt(geometry.half_sine_squared), geometry.n_dot_h))
        azimuth = np.arctan2(half_dir[:, 1], half_dir[:, 0]) - np.arctan2(view_dir[:, 1], view_dir[:, 0])
        theta_v = np.arctan2(np.hypot(view_dir[:, 0], view_dir[:, 1]), geometry.n_dot_v)
        view = _Knots.between(
            np.interp(theta_v, self.theta_v, np.arange(self.theta_v.size)), self.theta_v.size
        )
        x, y = self._warp(view, u_half, (azimuth / (2.0 * np.pi) + 0.5) % 1.0)
        weight = self._weight_at(view, x, y)
        facets = _lookup(self.ndf, u_half) / (4.0 * _lookup(self.sigma, _u_from_angle(theta_v)))
        return weight * (facets / geometry.n_dot_l)[:, None]

    @cached_property
    def _cumulative(self) -> tuple[Array, Array, Array]:
        """Density of integral 1 in each view's square; its integrals along X; and over all X along Y."""
        density = self.vndf / _trapezoids(_trapezoids(self.vndf)[..., -1])[:, -1, None, None]
        along_x = _trapezoids(density)
        return density, along_x, _trapezoids(along_x[..., -1])

    def _warp(self, view: "_Knots", u: Array, azimuth: Array) -> tuple[Array, Array]:
        """Shares of visible normals below `u` at this azimuth, and below this azimuth: the warped square."""
        density, along_x, along_y = self._cumulative
        rows, columns = density.shape[1:]
        column = _Knots.between(u * (columns - 1), columns)
        row = _Knots.between(azimuth * (rows - 1), rows)

        def in_row(table: Array, at: Indices) -> Array:
            """A table's column, between the neighbouring views and rows."""
            found = np.zeros_like(u)
            for t, view_share in view.corners:
                for j, row_share in row.corners:
                    found += view_share * row_share * table[t, j, at]
            return found

        low, high = in_row(density, column.below), in_row(density, column.below + 1)
        within = in_row(along_x, column.below) + _partial(column.share, low, high) / (columns - 1)
        total = in_row(along_x, np.full_like(column.below, columns - 1))
        x = np.divide(within, total, out=np.zeros_like(u), where=total > 0.0)
        y = np.zeros_like(u)
        for t, view_share in view.corners:
            low, high = along_x[t, row.below, -1], along_x[t, row.below + 1, -1]
            y += view_share * (along_y[t, row.below] + _partial(row.share, low, high) / (rows - 1))
        return np.clip(x, 0.0, 1.0), np.clip(y, 0.0, 1.0)

    def _weight_at(self, view: "_Knots", x: Array, y: Array) -> Array:
        rows, columns = self.weight.shape[2:]
        row, column = _Knots.between(y * (rows - 1), rows), _Knots.between(x * (columns - 1), columns)
        found = np.zeros((x.size, 3))
        for t, view_share in view.corners:
            for j, row_share in row.corners:
                for i, column_share in column.corners:
                    found += (view_share * row_share * column_share)[:, None] * self.weight[t, :, j, i]
        return found


class _Knots(NamedTuple):
    """Lower neighbours of positions among even knots, and the share of the upper ones."""

    below: Indices
    share: Array

    @classmethod
    def between(cls, position: Array, knots: int) -> "_Knots":
        below = np.clip(np.floor(position), 0, max(knots - 2, 0)).astype(np.intp)
        return cls(below, position - below)

    @property
    def corners(self) -> tuple[tuple[Indices, Array], tuple[Indices, Array]]:
        return (self.below, 1.0 - self.share), (self.below + (self.share > 0.0), self.share)


def _u_from_angle(theta: Array) -> Array:
    u: Array = np.sqrt(np.minimum(theta * (2.0 / np.pi), 1.0))
    return u


def _lookup(values: Array, u: Array) -> Array:
    found: Array = np.interp(u * (values.size - 1), np.arange(values.size), values)
    return found


def _partial(share: Array, low: Array, high: Array) -> Array:
    """Integral from 0 to `share` of the line from `low` at 0 to `high` at 1."""
    integral: Array = share * (low + share * (high - low) / 2.0)
    return integral


def _trapezoids(density: Array) -> Array:
    """Running integral over the last axis, which spans [0, 1], of a function linear between its values."""
    steps = (density[..., 1:] + density[..., :-1]) / (2.0 * (density.shape[-1] - 1))
    running: Array = np.concatenate([np.zeros_like(density[..., :1]), np.cumsum(steps, axis=-1)], axis=-1)
    return running
