"""The dual paraboloid map [Heidrich1998]: two hemispheres, each as a paraboloid mirror shows it.

Own axes: x to the right, y up, z towards the viewer. Sheet 0 is the hemisphere in `front`, z >= 0, sheet 1
the one at the `back`. A point (U, V) of the front, in radii of the hemisphere's disk, shows
(2 U, -2 V, 1 - U^2 - V^2) / (1 + U^2 + V^2), the same point of the back the opposite direction. That is
how published pairs are stored: the front is upside down, the back mirrored.

A map may reach beyond the hemisphere, by its `overscan`: the half-width of the square in radii of the disk.
Every texel shows a direction. Texels outside the disk repeat what the other sheet shows, so that a bilinear
lookup finds four texels that belong together.
"""

import numpy as np

from ..conventions import Array, ArrayLike, Indices
from ..errors import RangeError
from .azimuthal import disk_solid_angle

SHEETS = ("front", "back")


def disk_radius(overscan: float) -> float:
    """Radius of the hemisphere's disk.

    Parameters
    ----------
    overscan : float
        Half-width of a sheet in radii of the disk, at least 1.

    Returns
    -------
    float
        In half-widths of a sheet, in (0, 1].

    Raises
    ------
    RangeError
        `overscan` is below 1, so that directions would be missing.
    """
    if not 1.0 <= overscan < np.inf:
        raise RangeError(f"An overscan of {overscan:g} leaves directions out: give 1 or more.")
    return 1.0 / overscan


def direction_from_uv(uv: ArrayLike, sheet: Indices, overscan: float = 1.0) -> Array:
    """The direction that a point of the map shows, for the `overscan` of `disk_radius`.

    Raises
    ------
    RangeError
        See `disk_radius`.
    """
    xy = (2.0 * np.asarray(uv, dtype=np.float64) - 1.0) / disk_radius(overscan)
    square = np.sum(xy * xy, axis=-1, keepdims=True)
    front = np.concatenate([(2.0, -2.0) * xy, 1.0 - square], axis=-1) / (1.0 + square)
    direction: Array = np.where(np.asarray(sheet)[..., None] == 0, front, -front)
    return direction


def uv_from_direction(direction: ArrayLike, overscan: float = 1.0) -> tuple[Array, Indices]:
    """The inverse of `direction_from_uv`, within the disks.

    Raises
    ------
    RangeError
        See `disk_radius`.
    """
    direction = np.asarray(direction, dtype=np.float64)
    sheet = (direction[..., 2] < 0.0).astype(np.intp)
    front = np.where(sheet[..., None] == 0, direction, -direction)
    xy = (1.0, -1.0) * front[..., :2] / (1.0 + front[..., 2:])
    return 0.5 * disk_radius(overscan) * xy + 0.5, sheet


def texel_solid_angle(size: int, overscan: float = 1.0) -> Array:
    """Solid angle of every texel [sr], shape (2, size, size), within the disks: no direction counts twice.

    Exact, sums to 4 pi. A texel that the rim cuts counts with its part within; texels outside have 0.

    Raises
    ------
    RangeError
        See `disk_radius`.
    """

    def along_line(x: Array, y0: Array, y1: Array) -> Array:
        # The cap is 2 r^2 / (1 + r^2); its integral is a difference of arc tangents, computed as one.
        root = np.sqrt(1.0 + x * x)
        integral: Array = 2.0 * x / root * np.arctan2((y1 - y0) * root, 1.0 + x * x + y0 * y1)
        return integral

    sheet = disk_solid_angle(size, along_line, 1.0, 1.0 / disk_radius(overscan))
    return np.stack([sheet, sheet])


def wrap(
    columns: Indices, rows: Indices, sheet: Indices, width: int, height: int
) -> tuple[Indices, Indices, Indices]:
    """Texel that a lookup beyond a sheet's edge falls on: the edge's own."""
    return np.clip(columns, 0, width - 1), np.clip(rows, 0, height - 1), sheet
