"""Maps made small, to be looked at."""

import numpy as np

from ..conventions import Array

COLUMNS = {2: 2, 6: 3}
"""Number of square sheets below each other in a map -> number of sheets side by side in its picture."""


def thumbnail(radiance: Array, largest: int) -> Array:
    """A map as a small picture: its square sheets side by side, and means of whole blocks of texels.

    Parameters
    ----------
    radiance : ndarray, shape (height, width, 3)
        Row 0 at the bottom.
    largest : int
        Greatest width and height of the picture; a smaller map keeps its size.

    Returns
    -------
    ndarray, shape (height, width, 3), float64
        Row 0 at the bottom. Incomplete blocks at the top and the right are left out.
    """
    arranged = _side_by_side(radiance)
    height, width = arranged.shape[:2]
    step = -(-max(height, width) // largest)
    rows, columns = max(height // step, 1), max(width // step, 1)
    down, across = min(step, height), min(step, width)
    blocks = arranged[: rows * down, : columns * across].reshape(rows, down, columns, across, 3)
    small: Array = blocks.mean(axis=(1, 3), dtype=np.float64)
    return small


def _side_by_side(radiance: Array) -> Array:
    """Sheets from left to right, and from the top row to the bottom row; other maps as they are."""
    height, width = radiance.shape[:2]
    count, rest = divmod(height, width)
    if rest or count not in COLUMNS:
        return radiance
    across = COLUMNS[count]
    sheets = radiance.reshape(count // across, across, width, width, 3)
    # The first sheet is at the top, where row numbers are largest, so each row of sheets is turned around.
    return sheets[:, ::-1].transpose(0, 2, 1, 3, 4).reshape(-1, across * width, 3)
