"""Isotropic reflectance as a table over half and difference angles."""

from dataclasses import dataclass

import numpy as np

from ..conventions import Array, ArrayLike, Indices
from ..errors import ShapeError
from .model import Brdf, BrdfFunction, Geometry

DEFAULT_SHAPE = (90, 45, 60)
"""Cells of the half angle, the difference angle and its azimuth: 90 rings resolve alpha = 0.01."""


@dataclass(frozen=True, eq=False)
class Tabulated(Brdf):
    """A table of reflectance, interpolated linearly in all three angles.

    Attributes
    ----------
    table : ndarray, shape (H, D, P, 3), float64
        [1/sr] at the centres of cells that are even in the root of the half angle theta_h, in the difference
        angle theta_d, both over [0, pi/2], and in its azimuth phi_d over [0, pi).
    spec : str
        The text that stands for it, `merl:path=gold.binary` for example.
    reciprocal : bool
        Whether azimuths phi_d + pi, which swap light and view, have the values of phi_d. Otherwise they have
        those of 2 pi - (phi_d + pi): an isotropic surface is symmetric about the plane of normal and half
        vector.

    Raises
    ------
    ShapeError
        The table does not have four axes, the last with three channels.

    Notes
    -----
    Angles and spacing of [Rusinkiewicz1998] and [Matusik2003], which put cells where lobes are narrow.
    """

    table: Array
    spec: str
    reciprocal: bool = True

    def __post_init__(self) -> None:
        if self.table.ndim != 4 or self.table.shape[3] != 3 or 0 in self.table.shape:
            raise ShapeError(f"A reflectance table has shape (H, D, P, 3), not {self.table.shape}.")

    def above_horizon(self, geometry: Geometry) -> Array:
        """See `Brdf`."""
        half_cells, difference_cells, azimuth_cells = self.table.shape[:3]
        theta_h, theta_d, phi_d = half_difference_angles(geometry)
        half = _between(np.sqrt(theta_h * (2.0 / np.pi)) * half_cells, half_cells)
        difference = _between(theta_d * (2.0 / np.pi) * difference_cells, difference_cells)
        if self.reciprocal:
            position = phi_d / np.pi * azimuth_cells - 0.5
            below = np.floor(position)
            azimuth = below.astype(np.intp) % azimuth_cells, position - below
        else:
            azimuth = _between(np.abs(phi_d) / np.pi * azimuth_cells, azimuth_cells)
        brdf = np.zeros(geometry.light_dir.shape)
        for h, half_weight in _corners(half, half_cells):
            for d, difference_weight in _corners(difference, difference_cells):
                for p, azimuth_weight in _corners(azimuth, azimuth_cells):
                    weight = half_weight * difference_weight * azimuth_weight
                    brdf += weight[:, None] * self.table[h, d, p % azimuth_cells]
        return brdf


def cell_directions(shape: tuple[int, int, int]) -> tuple[Array, Array]:
    """The pair of directions at the centre of every cell of a table.

    Parameters
    ----------
    shape : three ints
        Cells of theta_h, theta_d and phi_d: (H, D, P).

    Returns
    -------
    light_dir, view_dir : ndarray, shape (H, D, P, 3), float64
        Unit vectors; many are below the horizon, where a table is not used. The half vector lies in the x-z
        plane.
    """
    half, difference, azimuth = ((np.arange(cells) + 0.5) / cells for cells in shape)
    theta_h = half[:, None, None] ** 2 * (np.pi / 2.0)
    theta_d = difference[:, None] * (np.pi / 2.0)
    return directions_from_angles(theta_h, theta_d, azimuth * np.pi)


def directions_from_angles(theta_h: ArrayLike, theta_d: ArrayLike, phi_d: ArrayLike) -> tuple[Array, Array]:
    """Light and view directions from half and difference angles.

    Parameters
    ----------
    theta_h, theta_d, phi_d : array_like, shapes (...,), broadcastable to each other
        Angle between normal and half vector, and, in the frame of the half vector, polar angle and azimuth of
        the light [radians].

    Returns
    -------
    light_dir, view_dir : ndarray, shape (..., 3), float64
        Unit vectors; the half vector lies in the x-z plane.

    Notes
    -----
    [Rusinkiewicz1998] section 3.
    """
    theta_h, theta_d, phi_d = np.broadcast_arrays(theta_h, theta_d, phi_d)
    half_dir = np.stack([np.sin(theta_h), np.zeros_like(theta_h), np.cos(theta_h)], axis=-1)
    tilted_x = np.stack([np.cos(theta_h), np.zeros_like(theta_h), -np.sin(theta_h)], axis=-1)
    across = np.cos(phi_d)[..., None] * tilted_x + np.sin(phi_d)[..., None] * (0.0, 1.0, 0.0)
    along, across = np.cos(theta_d)[..., None] * half_dir, np.sin(theta_d)[..., None] * across
    return along + across, along - across


def half_difference_angles(geometry: Geometry) -> tuple[Array, Array, Array]:
    """Half and difference angles of pairs of directions, the inverse of `directions_from_angles`.

    Parameters
    ----------
    geometry : Geometry
        N pairs of directions.

    Returns
    -------
    theta_h, theta_d, phi_d : ndarray, shape (N,), float64
        In [0, pi/2), [0, pi/2) and [-pi, pi] [radians].
    """
    theta_h = np.arctan2(np.sqrt(geometry.half_sine_squared), geometry.n_dot_h)
    difference = geometry.light_dir - geometry.view_dir
    theta_d = np.arctan2(np.linalg.norm(difference, axis=1) / 2.0, geometry.h_dot_l)
    # Both components of the light across the half vector, downhill and to the side, times the same factor
    half_x, half_y = geometry.half_dir[:, 0], geometry.half_dir[:, 1]
    phi_d = np.arctan2(half_x * difference[:, 1] - half_y * difference[:, 0], -difference[:, 2])
    return theta_h, theta_d, phi_d


def fill_missing(table: Array) -> Array:
    """Fill cells without a value from the nearest azimuth that has one.

    Parameters
    ----------
    table : ndarray, shape (H, D, P, 3)
        NaN in any channel marks a cell that was not measured, or is below the horizon.

    Returns
    -------
    ndarray, shape (H, D, P, 3)
        The table where there is a value; 0 where all azimuths lack one. Interpolation then does not darken
        cells just above the horizon by those just below.
    """
    missing = np.isnan(table).any(axis=3)
    cells = np.broadcast_to(np.arange(table.shape[2]), missing.shape)
    far = 2 * table.shape[2]
    before = np.maximum.accumulate(np.where(missing, -far, cells), axis=2)
    after = np.minimum.accumulate(np.where(missing, far, cells)[..., ::-1], axis=2)[..., ::-1]
    nearest = np.where(cells - before <= after - cells, before, after)
    filled = np.take_along_axis(table, np.clip(nearest, 0, table.shape[2] - 1)[..., None], axis=2)
    return np.nan_to_num(filled, nan=0.0)


def tabulate(brdf: BrdfFunction, spec: str, shape: tuple[int, int, int] = DEFAULT_SHAPE) -> Tabulated:
    """Measure any isotropic reflectance into a table.

    Parameters
    ----------
    brdf : callable
        A `Brdf`, or any function called like one; it is called once, with pairs above the horizon.
    spec : str
        The text that stands for the result.
    shape : three ints
        Cells of theta_h, theta_d and phi_d.

    Returns
    -------
    Tabulated
        Equal to `brdf` at the centres of the cells; elsewhere a linear interpolation.
    """
    light_dir, view_dir = cell_directions(shape)
    above = (light_dir[..., 2] > 0.0) & (view_dir[..., 2] > 0.0)
    table = np.full(light_dir.shape, np.nan)
    table[above] = brdf(light_dir[above], view_dir[above])
    return Tabulated(fill_missing(table), spec)


def _between(position: Array, cells: int) -> tuple[Indices, Array]:
    """Lower neighbour among cell centres and the share of the upper one; the ends are held."""
    position = np.clip(position - 0.5, 0.0, cells - 1.0)
    below = np.minimum(np.floor(position), max(cells - 2, 0))
    return below.astype(np.intp), position - below


def _corners(between: tuple[Indices, Array], cells: int) -> tuple[tuple[Indices, Array], ...]:
    below, share = between
    above = below if cells == 1 else below + 1
    return (below, 1.0 - share), (above, share)
