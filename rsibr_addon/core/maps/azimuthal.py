"""Solid angles of the texels of disk maps, which are symmetric about an axis.

Such a map shows the directions at the angle theta from its axis on a circle of some radius r. The circle's
inside is a cap of the sphere, and `cap` = 1 - cos(theta) [sr/rad] is its solid angle per radian of azimuth.
Green's theorem turns the solid angle of a texel into the integral of cap d(azimuth) along the texel's edges
and, where the rim cuts the texel, along the rim. Neighbours share their edges, so the solid angles sum to the
disk's to the last digits.
"""

from collections.abc import Callable

import numpy as np

from ..conventions import Array

AlongLine = Callable[[Array, Array, Array], Array]
"""Integral of cap d(azimuth) along the line at x, from (x, y0) to (x, y1), x and y >= 0."""

NODES = 12
"""Gauss-Legendre nodes on an edge: a relative error of 1e-12 on edges up to a quarter of the disk."""


def disk_solid_angle(size: int, along_line: AlongLine, cap_at_rim: float, extent: float = 1.0) -> Array:
    """Solid angle of every texel of a disk map, counted within the disk.

    Parameters
    ----------
    size : int
        Width and height of the map in texels.
    along_line : callable
        See `AlongLine`; lengths in units of the disk's radius.
    cap_at_rim : float
        1 - cos(theta) at the rim [sr/rad].
    extent : float
        Half the map's width in units of the disk's radius, at least 1.

    Returns
    -------
    ndarray, shape (size, size), float64
        [sr]; sums to 2 pi `cap_at_rim`.
    """
    # Texels of a map twice as fine never straddle an axis, so one quadrant gives all.
    lines = np.minimum(np.linspace(0.0, extent, size + 1), 1.0)
    within = np.sqrt(1.0 - lines * lines)[:, None]
    low, high = np.minimum(lines[:-1], within), np.minimum(lines[1:], within)
    line = np.broadcast_to(lines[:, None], low.shape)
    columns = np.diff(along_line(line, low, high), axis=0)
    rim = np.minimum(np.arccos(lines[:-1])[:, None], np.arcsin(lines[1:])) - np.maximum(
        np.arccos(lines[1:])[:, None], np.arcsin(lines[:-1])
    )
    quadrant = columns + columns.T + cap_at_rim * np.maximum(rim, 0.0)
    half = np.concatenate([quadrant[:, ::-1], quadrant], axis=1)
    disk = np.concatenate([half[::-1], half], axis=0)
    solid_angle: Array = disk.reshape(size, 2, size, 2).sum(axis=(1, 3))
    return solid_angle


def quadrature(cap_from_radius: Callable[[Array], Array]) -> AlongLine:
    """The integral along a line for a cap that has no closed form.

    Parameters
    ----------
    cap_from_radius : callable
        1 - cos(theta) from the radius, in (0, 1]; may have the slope of a square root at the rim.

    Returns
    -------
    callable
        See `AlongLine`.
    """
    nodes, weights = np.polynomial.legendre.leggauss(NODES)

    def along_line(x: Array, y0: Array, y1: Array) -> Array:
        # With y = half_chord sin(t), the distance from the rim is half_chord cos(t): no root is left.
        half_chord = np.sqrt(1.0 - x * x)
        safe = np.where(half_chord > 0.0, half_chord, 1.0)
        t0, t1 = np.arcsin(np.minimum(y0 / safe, 1.0)), np.arcsin(np.minimum(y1 / safe, 1.0))
        total = np.zeros_like(x)
        for node, weight in zip(nodes, weights, strict=True):
            t = 0.5 * (t0 + t1) + 0.5 * node * (t1 - t0)
            square = x * x + (half_chord * np.sin(t)) ** 2
            cap = cap_from_radius(np.sqrt(square))
            total += weight * np.divide(cap, square, out=np.zeros_like(x), where=square > 0.0) * np.cos(t)
        integral: Array = x * half_chord * 0.5 * (t1 - t0) * total
        return integral

    return along_line
