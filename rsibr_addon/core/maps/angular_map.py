"""The angular map of light probes [Debevec1998]: the angle from the middle grows with the radius.

Own axes: x to the right, y up, z towards the viewer. The middle shows -z, straight ahead; the whole rim shows
+z. Texels outside the inscribed disk show no direction.
"""

import numpy as np

from ..conventions import Array, ArrayLike
from .azimuthal import disk_solid_angle, quadrature
from .sphere_map import wrap

__all__ = ["direction_from_uv", "texel_solid_angle", "uv_from_direction", "wrap"]


def direction_from_uv(uv: ArrayLike) -> Array:
    """The direction that a point of the map shows; outside the disk, that of the nearest point of its rim.

    The angle from -z is pi times the radius, in radii of the disk.
    """
    xy = 2.0 * np.asarray(uv, dtype=np.float64) - 1.0
    radius = np.linalg.norm(xy, axis=-1, keepdims=True)
    xy = xy / np.maximum(radius, 1.0)
    radius = np.minimum(radius, 1.0)
    # sinc is sin(pi r) / (pi r), and 1 in the middle.
    return np.concatenate([np.pi * np.sinc(radius) * xy, -np.cos(np.pi * radius)], axis=-1)


def uv_from_direction(direction: ArrayLike) -> Array:
    """The inverse of `direction_from_uv`; +z, which the whole rim shows, is mapped to its rightmost point."""
    direction = np.asarray(direction, dtype=np.float64)
    xy, z = direction[..., :2], direction[..., 2:]
    sine = np.linalg.norm(xy, axis=-1, keepdims=True)
    radius = np.arctan2(sine, -z) / np.pi
    towards = np.where(sine > 0.0, xy / np.where(sine > 0.0, sine, 1.0), (1.0, 0.0))
    uv: Array = 0.5 * radius * towards + 0.5
    return uv


def texel_solid_angle(size: int) -> Array:
    """Solid angle of every texel [sr], shape (size, size), by quadrature along the texels' edges.

    To 1e-12 of their sum, 4 pi. A texel that the rim cuts counts with its part within; texels outside have 0.
    """
    along_line = quadrature(lambda radius: 2.0 * np.sin(0.5 * np.pi * radius) ** 2)
    return disk_solid_angle(size, along_line, 2.0)
