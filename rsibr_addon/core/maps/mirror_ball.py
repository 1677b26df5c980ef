"""The mirror ball: a photograph of a mirrored ball, cut to the ball's outline.

Own axes: those of the camera, x to the right, y up, z towards the camera, which stands on the z axis at a
finite distance from the ball's centre. The surroundings are taken to be far away. From a finite distance the
outline shows less than the ball's hemisphere, and there is a blind spot: the directions that the ball hides,
a cone about -z with the half-angle arcsin(1 / distance). As the distance grows the map becomes a
`sphere_map`.
"""

import numpy as np

from ..conventions import Array, ArrayLike
from ..errors import RangeError
from .azimuthal import disk_solid_angle, quadrature
from .sphere_map import wrap

__all__ = [
    "blind_angle",
    "direction_from_uv",
    "incidence_cosine",
    "texel_solid_angle",
    "uv_from_direction",
    "wrap",
]

MOST_STEPS = 50
"""Most steps of Newton's method: it takes about six; from a distance of 1.001 radii some more."""


def blind_angle(distance: float) -> float:
    """Half-angle of the cone about -z that the ball hides from the camera.

    Parameters
    ----------
    distance : float
        From the ball's centre to the camera, in radii of the ball, above 1; may be infinite.

    Returns
    -------
    float
        [rad], in [0, pi/2).

    Raises
    ------
    RangeError
        The camera is inside the ball.
    """
    if not distance > 1.0:
        raise RangeError(f"A camera {distance:g} radii from a ball's centre is in the ball: step back.")
    return float(np.arcsin(1.0 / distance))


def direction_from_uv(uv: ArrayLike, distance: float) -> Array:
    """The direction that a point of the photograph shows, from the `distance` of `blind_angle`.

    Points outside the ball are taken at the nearest point of its outline. The line of sight and the mirrored
    ray are at the same angle from the normal, the incidence.

    Raises
    ------
    RangeError
        See `blind_angle`.
    """
    xy = 2.0 * np.asarray(uv, dtype=np.float64) - 1.0
    radius = np.linalg.norm(xy, axis=-1, keepdims=True)
    towards = np.where(radius > 0.0, xy / np.where(radius > 0.0, radius, 1.0), 0.0)
    angle = _angle_from_radius(np.minimum(radius, 1.0), distance)
    return np.concatenate([np.sin(angle) * towards, np.cos(angle)], axis=-1)


def uv_from_direction(direction: ArrayLike, distance: float) -> Array:
    """The inverse of `direction_from_uv`; directions in the blind spot are mapped to the outline.

    Raises
    ------
    RangeError
        See `blind_angle`.

    Notes
    -----
    With the normal at the angle a from z, the ray to the camera stands at g below z, tan g =
    sin a / (distance - cos a), and the mirrored ray at 2 a + g. That is inverted by Newton's
    method: the sum is concave, so from below it converges without overshooting.
    """
    direction = np.asarray(direction, dtype=np.float64)
    xy, z = direction[..., :2], direction[..., 2:]
    blind, inverse = blind_angle(distance), 1.0 / distance
    sine = np.linalg.norm(xy, axis=-1, keepdims=True)
    angle = np.minimum(np.arctan2(sine, z), np.pi - blind)
    normal = np.maximum(0.5 * (angle - blind), 0.0)
    for _ in range(MOST_STEPS):
        across, along = inverse * np.sin(normal), 1.0 - inverse * np.cos(normal)
        slope = 2.0 + inverse * (np.cos(normal) - inverse) / (across * across + along * along)
        step = (angle - 2.0 * normal - np.arctan2(across, along)) / slope
        normal = normal + step
        if np.all(np.abs(step) < 1e-15):
            break
    radius = np.sin(normal) * np.cos(blind) / (1.0 - inverse * np.cos(normal))
    towards = np.where(sine > 0.0, xy / np.where(sine > 0.0, sine, 1.0), (1.0, 0.0))
    uv: Array = 0.5 * np.minimum(radius, 1.0) * towards + 0.5
    return uv


def texel_solid_angle(size: int, distance: float) -> Array:
    """Solid angle of every texel [sr], shape (size, size), by quadrature along the texels' edges.

    To 1e-12 of their sum, 4 pi less the blind spot. A texel that the outline cuts counts with its part
    within; texels outside have 0.

    Raises
    ------
    RangeError
        See `blind_angle`.
    """
    along_line = quadrature(lambda radius: 2.0 * np.sin(0.5 * _angle_from_radius(radius, distance)) ** 2)
    return disk_solid_angle(size, along_line, 1.0 + float(np.cos(blind_angle(distance))))


def incidence_cosine(uv: ArrayLike, distance: float) -> Array:
    """Cosine of the angle at which the camera sees the ball's surface, shape (...).

    Parameters
    ----------
    uv : array_like, shape (..., 2)
        Points of the photograph; those outside the ball are taken at its outline, where this is 0.
    distance : float
        See `blind_angle`.

    Raises
    ------
    RangeError
        See `blind_angle`.
    """
    radius = np.linalg.norm(2.0 * np.asarray(uv, dtype=np.float64) - 1.0, axis=-1)
    cosine: Array = np.cos(_incidence(np.minimum(radius, 1.0), distance))
    return np.maximum(cosine, 0.0)


def _incidence(radius: Array, distance: float) -> Array:
    """Angle between the line of sight and the normal at a radius: 90 degrees on the outline."""
    cosine = np.cos(blind_angle(distance))
    incidence: Array = np.arctan2(radius, cosine * np.sqrt(np.maximum(1.0 - radius * radius, 0.0)))
    return incidence


def _angle_from_radius(radius: Array, distance: float) -> Array:
    """Angle from z of the direction that the ball shows at a radius, in radii of its outline."""
    sight = np.arctan2(radius / distance, np.cos(blind_angle(distance)))
    angle: Array = 2.0 * _incidence(radius, distance) - sight
    return angle
