"""A wrinkled mirror ball under a small lamp: what [Miller1984] section 8 is about, in closed form."""

import numpy as np
from rsibr.rsibr_addon.core.directions import normalize, reflect

EYE = np.array([0.0, -1.0, 0.0])
HALF_FRAME = 0.85
"""Of the picture's width, in radii of the ball: the outline stays outside."""


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
    x, z = np.meshgrid(*[HALF_FRAME / np.sqrt(2.0) * (2.0 * across - 1.0)] * 2)
    y = -np.sqrt(1.0 - x**2 - z**2)
    slope_x = np.cos(9.0 * x + 4.0 * z) + np.cos(5.0 * x - 11.0 * z + 1.0)
    slope_z = np.cos(12.0 * z + 2.0 * x + 2.0) + np.cos(7.0 * z - 8.0 * x)
    normal = normalize(np.stack([x + wrinkles * slope_x, y, z + wrinkles * slope_z], axis=-1))
    direction = reflect(np.broadcast_to(EYE, normal.shape), normal)
    cosine, sine = np.cos(turn), np.sin(turn)
    return direction @ np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]])


def lamp_table(height: int, row: int, column: int, size: int, radiance: float) -> np.ndarray:
    """A black table of shape (height, 2 * height, 1) with a square lamp, columns counted past the seam."""
    table = np.zeros((height, 2 * height, 1))
    table[row : row + size, np.arange(column, column + size) % (2 * height)] = radiance
    return table
