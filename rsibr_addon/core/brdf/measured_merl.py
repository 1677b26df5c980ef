"""Reflectance from the MERL database: 100 materials measured from photographs of spheres."""

import numpy as np
from numpy.typing import NDArray

from ..conventions import Array
from ..errors import ShapeError
from .tabulated import Tabulated, cell_directions, fill_missing

SHAPE = (90, 90, 180)
"""Cells of theta_h, theta_d and phi_d, the file format's only size."""

SCALE = np.array([1.0, 1.15, 1.66]) / 1500.0
"""[1/sr] per unit of the stored red, green and blue."""


def below_horizon() -> NDArray[np.bool_]:
    """Whether each cell's centre is below the horizon, where nothing can be measured; bool, shape `SHAPE`."""
    light_dir, view_dir = cell_directions(SHAPE)
    return np.minimum(light_dir[..., 2], view_dir[..., 2]) <= 0.0


def merl_brdf(samples: Array, spec: str) -> Tabulated:
    """The model of a MERL measurement.

    Parameters
    ----------
    samples : ndarray, shape (90, 90, 180, 3)
        As stored, red, green and blue last; NaN where nothing was measured.
    spec : str
        The text that stands for it.

    Returns
    -------
    Tabulated
        Scaled to 1/sr; linear between the centres of cells, where [Matusik2003] takes the nearest cell.

    Raises
    ------
    ShapeError
        The samples have another shape.

    Notes
    -----
    Scale and spacing of [Matusik2003] as the database's own reader states them.
    """
    if samples.shape != (*SHAPE, 3):
        raise ShapeError(f"MERL samples have shape {(*SHAPE, 3)}, not {samples.shape}.")
    return Tabulated(fill_missing(samples * SCALE), spec)
