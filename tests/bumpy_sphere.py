"""A wrinkled mirror ball under a small lamp: what [Miller1984] section 8 is about, in closed form."""

from collections.abc import Callable

import numpy as np
from rsibr.rsibr_addon.core.antialiased.footprint import footprint_box, footprint_parts, pixel_footprints
from rsibr.rsibr_addon.core.antialiased.quadrilateral import quadrilateral_mean
from rsibr.rsibr_addon.core.antialiased.recursive import recursive_mean, table_entry
from rsibr.rsibr_addon.core.antialiased.summed_area import box_mean, summed_area_table
from rsibr.rsibr_addon.core.geometry.directions import normalize, reflect

EYE = np.array([0.0, -1.0, 0.0])
HALF_FRAME = 0.85
"""Half the picture's diagonal in radii of the ball: its outline stays outside."""

SAMPLES = 16
"""Lookups of the reference along a side of a pixel."""

WAYS = ("recursive", "quadrilateral", "summed_area")


def reflected_directions(across: np.ndarray, wrinkles: float, turn: float) -> np.ndarray:
    """What the ball reflects at a square lattice of points of an orthographic picture.

    Parameters
    ----------
    across : ndarray, shape (n,)
        Where the lattice's columns, and rows, stand in the picture: 0 to 1 from edge to edge.
    wrinkles : float
        Steepness of the wrinkles; 0 for a smooth ball.
    turn : float
        Angle by which the world has turned about the vertical axis [rad].

    Returns
    -------
    ndarray, shape (n, n, 3)
        Unit directions, row 0 at the bottom.
    """
    normal = wrinkled_normals(across, wrinkles)
    direction = reflect(np.broadcast_to(EYE, normal.shape), normal)
    cosine, sine = np.cos(turn), np.sin(turn)
    return direction @ np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]])


def wrinkled_normals(across: np.ndarray, wrinkles: float) -> np.ndarray:
    """The ball's unit normals, as `reflected_directions` takes them."""
    x, z = np.meshgrid(*[HALF_FRAME / np.sqrt(2.0) * (2.0 * across - 1.0)] * 2)
    y = -np.sqrt(1.0 - x**2 - z**2)
    slope_x = np.cos(9.0 * x + 4.0 * z) + np.cos(5.0 * x - 11.0 * z + 1.0)
    slope_z = np.cos(12.0 * z + 2.0 * x + 2.0) + np.cos(7.0 * z - 8.0 * x)
    return normalize(np.stack([x + wrinkles * slope_x, y, z + wrinkles * slope_z], axis=-1))


def footprints(size: int, wrinkles: float, turn: float) -> tuple[np.ndarray, np.ndarray]:
    """What a picture's pixels reflect: at their middles, shape (size, size, 3), and at their corners."""
    middle = reflected_directions((np.arange(size) + 0.5) / size, wrinkles, turn)
    return middle, pixel_footprints(reflected_directions(np.arange(size + 1) / size, wrinkles, turn))


def supersampled(
    lookup: Callable[[np.ndarray], np.ndarray], size: int, wrinkles: float, turn: float
) -> np.ndarray:
    """A picture whose pixels are means of 16 x 16 lookups, shape (size, size, channels)."""
    across = (np.arange(size * SAMPLES) + 0.5) / (size * SAMPLES)
    seen = lookup(reflected_directions(across, wrinkles, turn))
    return seen.reshape(size, SAMPLES, size, SAMPLES, -1).mean(axis=(1, 3))


def lamp_table(height: int, row: int, column: int, size: int, radiance: float) -> np.ndarray:
    """A black table of shape (height, 2 * height, 1) with a square lamp, columns counted past the seam."""
    table = np.zeros((height, 2 * height, 1))
    table[row : row + size, np.arange(column, column + size) % (2 * height)] = radiance
    return table


def pictures(table: np.ndarray, size: int, wrinkles: float, turn: float) -> dict[str, np.ndarray]:
    """A picture by each way, by a single lookup a pixel ("point"), and by 16 x 16 of them ("reference").

    Parameters
    ----------
    table : ndarray, shape (height, width, channels)
    size : int
        Pixels along a side.
    wrinkles, turn : float
        As in `reflected_directions`.

    Returns
    -------
    dict of str to ndarray, shape (size, size, channels)
    """

    def lookup(direction: np.ndarray) -> np.ndarray:
        columns, rows = table_entry(table, direction)
        return table[rows, columns]

    middle, corners = footprints(size, wrinkles, turn)
    return {
        "reference": supersampled(lookup, size, wrinkles, turn),
        "point": lookup(middle),
        "recursive": recursive_mean(table, corners),
        "quadrilateral": quadrilateral_mean(table, corners),
        "summed_area": summed_area_mean(table, corners),
    }


def summed_area_mean(table: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """As `summed_area.footprint_mean`, but with boxes where pixels are small, too."""
    height, width = table.shape[:2]
    summed, mean = summed_area_table(table), np.zeros((*corners.shape[:-2], table.shape[-1]))
    for chosen, part, weight in footprint_parts(corners, height):
        mean[chosen] += weight * box_mean(summed, footprint_box(part, width, height))
    return mean


def energy(frames: list[dict[str, np.ndarray]], way: str) -> np.ndarray:
    """The highlights' energy over the reference's, frame by frame."""
    return np.array([frame[way].sum() / frame["reference"].sum() for frame in frames])


def flicker(frames: list[dict[str, np.ndarray]], way: str) -> float:
    """Relative variation of that energy from frame to frame."""
    found = energy(frames, way)
    return float(np.std(found) / np.mean(found))


def error(frames: list[dict[str, np.ndarray]], way: str) -> float:
    """Root mean square of a way's error, relative to that of the reference."""
    squares = [
        (np.mean((frame[way] - frame["reference"]) ** 2), np.mean(frame["reference"] ** 2))
        for frame in frames
    ]
    wrong, whole = np.mean(squares, axis=0)
    return float(np.sqrt(wrong / whole))


def missing(frames: list[dict[str, np.ndarray]], way: str) -> float:
    """Part of the highlights' pixels, a tenth as bright as the brightest or more, that a way leaves black."""
    lit = [frame["reference"] > 0.1 * frame["reference"].max() for frame in frames]
    return float(
        np.mean(np.concatenate([frame[way][on] == 0.0 for frame, on in zip(frames, lit, strict=True)]))
    )
