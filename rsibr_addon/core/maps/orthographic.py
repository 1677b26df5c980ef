"""The orthographic pair [Miller1984]: each hemisphere projected onto the xy plane.

Own axes: x to the right, y up, z towards the viewer. Section 4.2: u = x and v = y, and there are two map
arrays, sheet 0 for z >= 0, the `front`, and sheet 1 for z < 0, the `back`. Texels outside the inscribed
disks belong to no direction.
"""

import numpy as np

from ..conventions import Array, ArrayLike, Indices
from .azimuthal import disk_solid_angle
from .dual_paraboloid import SHEETS, wrap
from .sphere_map import normal_from_uv

__all__ = ["SHEETS", "direction_from_uv", "texel_solid_angle", "uv_from_direction", "wrap"]


def direction_from_uv(uv: ArrayLike, sheet: Indices) -> Array:
    """The direction that a point of the map shows; outside the disk, that of the nearest point of its rim."""
    front = normal_from_uv(uv)
    direction: Array = np.where(np.asarray(sheet)[..., None] == 0, front, front * (1.0, 1.0, -1.0))
    return direction


def uv_from_direction(direction: ArrayLike) -> tuple[Array, Indices]:
    """The inverse of `direction_from_uv`."""
    direction = np.asarray(direction, dtype=np.float64)
    return 0.5 * direction[..., :2] + 0.5, (direction[..., 2] < 0.0).astype(np.intp)


def texel_solid_angle(size: int) -> Array:
    """Solid angle of every texel [sr], shape (2, size, size): exact, sums to 4 pi.

    A texel that the rim cuts counts with its part within; texels outside have 0.
    """
    sheet = disk_solid_angle(size, _along_line, 1.0)
    return np.stack([sheet, sheet])


def _along_line(x: Array, y0: Array, y1: Array) -> Array:
    """The cap is 1 - z with z = sqrt(1 - x^2 - y^2): see `azimuthal.AlongLine`."""

    def antiderivative(y: Array) -> Array:
        # atan2(y, x) - atan2(y, x z) + x atan2(y, z), with the first two, nearly equal, as one.
        square = x * x + y * y
        z = np.sqrt(np.maximum(1.0 - square, 0.0))
        integral: Array = x * np.arctan2(y, z) - np.arctan2(x * y * square / (1.0 + z), x * x * z + y * y)
        return integral

    return antiderivative(y1) - antiderivative(y0)
