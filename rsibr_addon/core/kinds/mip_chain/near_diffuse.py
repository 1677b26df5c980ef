"""Diffuse light in a near room: each part of the hemisphere is looked up where it meets the walls.

Harmonics are those of one point. But a mip is the light of a narrow lobe about any direction, and some such
lobes make up the cosine about a normal.
"""

from collections.abc import Iterator

import numpy as np

from ...conventions import Array
from ...geometry.directions import camera_frame

EXPONENT = 16.0
"""Of Phong's lobe that the mip shows."""

RINGS = ((1, 0.0, 0.110), (5, 35.0, 0.490), (8, 62.0, 0.400))
"""Number of lobes on a ring, their angle from the normal in degrees, and their share together: the least
squares' fit of the cosine, whose harmonics it has to 3.6 %."""


def cosine_lobes(normal: Array) -> Iterator[tuple[Array, float]]:
    """Lobes that make up the cosine about normals.

    Parameters
    ----------
    normal : ndarray, shape (..., 3)
        Unit vectors.

    Yields
    ------
    direction : ndarray, shape (..., 3)
        Unit vectors, axes of Phong lobes of `EXPONENT`.
    share : float
        Of a lobe; all together are 1.

    Notes
    -----
    GLSL twin: gpu_shaders/lib/near_diffuse_lib.glsl `cosine_lobe`, 1e-6.
    """
    frame = camera_frame(normal)
    for ring, (count, angle, share) in enumerate(RINGS):
        away = np.radians(angle)
        for number in range(count):
            azimuth = 2.0 * np.pi * (number + 0.5 * ring) / count
            local = np.sin(away) * np.cos(azimuth), np.sin(away) * np.sin(azimuth), np.cos(away)
            yield frame @ np.array(local), share / count
