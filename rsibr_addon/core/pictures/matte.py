"""What stands behind an object in a picture: its light or a photograph, and a floor that takes its shadow.

A pixel shows the object by its coverage, and else what lies behind. The floor is not seen itself: where the
object keeps light from it, what lies behind is darker by the same share.
"""

from dataclasses import dataclass

import numpy as np

from ..conventions import Array, ArrayLike, texel_centres
from ..errors import ShapeError
from ..geometry.camera import Camera
from ..geometry.directions import normalize
from ..resample import bilinear, clamp_to_edge

EXTENT = 4.0
"""Half-width of the floor that takes shadows, in radii of the object; they fade in the outer quarter."""

BACKDROP_ANGLE = np.radians(40.0)
"""Angle of view on what lies behind in an orthographic picture, all whose rays have one direction."""


@dataclass(frozen=True)
class PictureFrame:
    """The frame of a picture, which may be more or less than what is drawn.

    Attributes
    ----------
    projection : ndarray, shape (4, 4)
        From eye coordinates to the frame's, by the same camera as what is drawn.
    aspect : float
        Width over height.
    """

    projection: Array
    aspect: float


def rays(camera: Camera, size: int) -> tuple[Array, Array]:
    """Rays through the middles of pixels.

    Parameters
    ----------
    camera : Camera
    size : int
        Width and height of a picture in pixels.

    Returns
    -------
    origins, directions : ndarray, shape (size, size, 3)
        Row 0 at the bottom; the directions are unit vectors.
    """
    points = 2.0 * texel_centres(size, size) - 1.0
    right, up, back = camera.frame.T
    middle = camera.distance * np.asarray(camera.view_dir)
    if camera.field_of_view is None:
        origins = middle + points[..., :1] * right + points[..., 1:] * up
        return origins, np.broadcast_to(-back, origins.shape)
    half = np.tan(0.5 * camera.field_of_view)
    directions = normalize(half * (points[..., :1] * right + points[..., 1:] * up) - back)
    return np.broadcast_to(middle, directions.shape), directions


def backdrop_directions(camera: Camera, size: int) -> Array:
    """Directions in which pixels see what is far behind, shape (size, size, 3): see `BACKDROP_ANGLE`."""
    seen = Camera(camera.view_dir, camera.field_of_view or BACKDROP_ANGLE)
    return rays(seen, size)[1]


def fitted(picture: Array, size: int) -> Array:
    """The middle of a picture, to fill a square frame.

    Parameters
    ----------
    picture : ndarray, shape (height, width, channels)
    size : int
        Width and height of the frame in pixels.

    Returns
    -------
    ndarray, shape (size, size, channels), float64
        Each pixel is the mean over its square of the picture.
    """
    height, width = picture.shape[:2]
    side = min(height, width)
    top, left = (height - side) // 2, (width - side) // 2
    shares = _shares(side, size)
    square = picture[top : top + side, left : left + side].astype(np.float64)
    rows = np.tensordot(shares, square, axes=1)
    made: Array = np.moveaxis(np.tensordot(shares, rows, axes=(1, 1)), 0, 1)
    return made


def _shares(texels: int, pixels: int) -> Array:
    """How much of each pixel each texel fills along an axis, shape (pixels, texels): rows sum to 1."""
    edges = np.arange(pixels + 1) * texels / pixels
    texel = np.arange(texels)
    shares: Array = np.clip(
        np.minimum(edges[1:, None], texel + 1.0) - np.maximum(edges[:-1, None], texel), 0.0, None
    )
    return shares * pixels / texels


def flattened(direction: ArrayLike, height: float) -> Array:
    """The shadow that a lamp makes on a floor, as a matrix.

    Parameters
    ----------
    direction : array_like, shape (3,)
        Unit vector towards the lamp, above the horizon.
    height : float
        The floor's z.

    Returns
    -------
    ndarray, shape (4, 4), float64
        World coordinates to x and y on the floor and 0, for column vectors.
    """
    x, y, z = np.asarray(direction, dtype=np.float64)
    return np.array(
        [
            [1.0, 0.0, -x / z, height * x / z],
            [0.0, 1.0, -y / z, height * y / z],
            [0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )


def floor_from_world(matrix: Array, plane: Array, eye: Array) -> Array | None:
    """Coordinates of a floor, which lies at z = 0 and is seen from above.

    Parameters
    ----------
    matrix : ndarray, shape (4, 4)
        The world's coordinates from the plane's.
    plane : ndarray, shape (2, 3)
        A point of the plane, and its normal.
    eye : ndarray, shape (4,)
        Homogeneous position of the eye in the world.

    Returns
    -------
    ndarray, shape (4, 4), or None
        A rotation, and a translation; None where the matrix makes a line or a point of the plane.
    """
    point, normal = plane
    linear, place = matrix[:3, :3], matrix[:3, :3] @ point + matrix[:3, 3]
    side = np.cross(np.eye(3)[np.argmin(np.abs(normal))], normal)
    along, up = linear @ side, np.cross(linear @ side, linear @ np.cross(normal, side))
    if not up.any():
        return None
    along, up = normalize(along), normalize(up)
    up = up if up @ (eye[:3] - eye[3] * place) >= 0.0 else -up
    made: Array = np.eye(4)
    made[:3, :3] = along, np.cross(up, along), up
    made[:3, 3] = -made[:3, :3] @ place
    return made


def floor_area(corners: Array) -> tuple[Array, float]:
    """The square of a floor that takes shadows.

    Parameters
    ----------
    corners : ndarray, shape (n, 3)
        Of the bounds of what casts them, in the floor's coordinates; some are above it.

    Returns
    -------
    middle : ndarray, shape (2,)
    half_width : float
        What stands on the floor is within the three quarters where shadows do not fade, and they may be about
        as long as it is high.
    """
    height = corners[:, 2].max()
    low, high = corners[:, :2].min(axis=0), corners[:, :2].max(axis=0)
    return 0.5 * (low + high), float(0.5 * np.hypot(*(high - low)) / 0.75 + 1.5 * height)


def floor_share(camera: Camera, height: float, shadow: Array, irradiance: ArrayLike, size: int) -> Array:
    """The share of its light that each pixel's point of the floor gets.

    Parameters
    ----------
    camera : Camera
    height : float
        The floor's z.
    shadow : ndarray, shape (n, n, 3)
        Irradiance that the object takes, as `device.floor_shadow.floor_shadow` makes it.
    irradiance : array_like, shape (3,)
        Irradiance of the floor without the object.
    size : int
        Width and height of the picture in pixels.

    Returns
    -------
    ndarray, shape (size, size, 3), float64
        In [0, 1]; 1 where a pixel does not see the floor from above.

    Raises
    ------
    ShapeError
        The map is not square.
    """
    if shadow.shape[0] != shadow.shape[1]:
        raise ShapeError(f"A floor's map is square, not {shadow.shape[1]}x{shadow.shape[0]}.")
    origins, directions = rays(camera, size)
    down = np.minimum(directions[..., 2], -1e-6)
    along = (height - origins[..., 2]) / down
    seen = (directions[..., 2] < 0.0) & (along > 0.0)
    place = (origins + along[..., None] * directions)[..., :2]
    distance = np.linalg.norm(place, axis=-1) / EXTENT
    strength = np.where(seen, np.clip(4.0 * (1.0 - distance), 0.0, 1.0), 0.0)
    uv = np.clip(0.5 + 0.5 * place / EXTENT, 0.0, 1.0)
    taken = bilinear(shadow, np.nan_to_num(uv), clamp_to_edge)
    lost = np.divide(taken, irradiance, out=np.zeros_like(taken), where=np.asarray(irradiance) > 0.0)
    return 1.0 - strength[..., None] * np.clip(lost, 0.0, 1.0)


def over(picture: Array, behind: Array) -> Array:
    """A picture over an opaque one.

    Parameters
    ----------
    picture : ndarray, shape (size, size, 4)
        Radiance times coverage, and coverage.
    behind : ndarray, shape (size, size, 3)

    Returns
    -------
    ndarray, shape (size, size, 4), float32
    """
    covered = picture[..., :3] + (1.0 - picture[..., 3:]) * behind
    return np.concatenate([covered, np.ones_like(covered[..., :1])], axis=-1).astype(np.float32)
