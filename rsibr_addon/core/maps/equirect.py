"""The latitude-longitude map, as Cycles reads it: u = 0.5 - atan2(y, x) / 2 pi, v from the bottom."""

import numpy as np

from ..conventions import Array, ArrayLike, Indices


def direction_from_uv(uv: ArrayLike) -> Array:
    """The direction that a point shows: u goes around the horizon, +X in the middle, v from -Z to +Z."""
    u, v = np.moveaxis(np.asarray(uv, dtype=np.float64), -1, 0)
    azimuth, polar = np.pi * (1.0 - 2.0 * u), np.pi * (1.0 - v)
    sine = np.sin(polar)
    return np.moveaxis(np.stack([sine * np.cos(azimuth), sine * np.sin(azimuth), np.cos(polar)]), 0, -1)


def direction_of_grid(u: Array, v: Array) -> Array:
    """The directions that a grid shows, shape (rows, columns, 3), given u of its columns and v of its rows.

    Their sines and cosines are those of rows and columns, which takes a fraction of `direction_from_uv`.
    """
    azimuth = np.pi * (1.0 - 2.0 * u)
    polar = np.pi * (1.0 - v[:, None])
    direction = np.empty((3, len(v), len(u)))
    np.multiply(np.sin(polar), np.cos(azimuth), out=direction[0])
    np.multiply(np.sin(polar), np.sin(azimuth), out=direction[1])
    direction[2] = np.cos(polar)
    return np.moveaxis(direction, 0, -1)


def uv_from_direction(direction: ArrayLike) -> Array:
    """The inverse of `direction_from_uv`; the poles, where u is arbitrary, have u = 0.5."""
    direction = np.asarray(direction, dtype=np.float64)
    x, y, z = direction[..., 0], direction[..., 1], direction[..., 2]
    u = 0.5 - np.arctan2(y, x) / (2.0 * np.pi)
    # atan2 keeps its digits near the poles, where acos(z) loses half of them.
    v = 1.0 - np.arctan2(np.hypot(x, y), z) / np.pi
    return np.moveaxis(np.stack([u, v]), 0, -1)


def texel_solid_angle(width: int, height: int) -> Array:
    """Solid angle of every texel [sr], shape (height, width): exact, sums to 4 pi.

    It is a view of one column, not to be written to.
    """
    # The difference of the edges' cosines, as a product, which keeps its digits at the poles.
    middle = np.pi * (np.arange(height) + 0.5) / height
    bands = 2.0 * np.sin(middle) * np.sin(0.5 * np.pi / height)
    return np.broadcast_to((bands * 2.0 * np.pi / width)[:, None], (height, width))


def sectors(image: Array) -> list[tuple[Array, Array]]:
    """Views of a map's sixteen sectors, each an eighth of the horizon below or above it.

    Parameters
    ----------
    image : ndarray, shape (..., height, width, channels)
        The width is a multiple of 8.

    Returns
    -------
    list of (ndarray, ndarray)
        The matrix, shape (3, 3), that takes directions of the first sector there, and the view, in the order
        of the first one's texels.
    """
    height, width = image.shape[-3] // 2, image.shape[-2] // 8
    found = []
    for number in range(8):
        # The first, turned by quarters as columns go; every second one is mirrored
        cosine, sine = ((1, 0), (0, -1), (-1, 0), (0, 1))[(number + 1) // 2 % 4]
        side = -1 if number % 2 else 1
        eighth = image[..., number * width : (number + 1) * width, :][..., ::side, :]
        for up, view in ((1, eighth[..., :height, :, :]), (-1, eighth[..., : height - 1 : -1, :, :])):
            matrix = np.array([[cosine, -side * sine, 0], [sine, side * cosine, 0], [0, 0, up]])
            found.append((matrix, view))
    return found


def wrap(columns: Indices, rows: Indices, width: int, height: int) -> tuple[Indices, Indices]:
    """Texel that a lookup beyond the edge falls on: around the horizon, and over a pole to its far side.

    The width must be even for a pole to have a far side.
    """
    below, above = rows < 0, rows >= height
    over_pole = below | above
    rows = np.where(below, -1 - rows, np.where(above, 2 * height - 1 - rows, rows))
    columns = np.where(over_pole, columns + width // 2, columns)
    return columns % width, rows
