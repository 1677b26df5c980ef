"""Environments from photographs of a mirrored ball: [Miller1984] section 5.1, the second way."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..brdf.fresnel import fresnel_schlick
from ..conventions import Array, ArrayLike, texel_centres
from ..errors import RangeError
from ..geometry.directions import camera_frame, dot
from ..maps.mirror_ball import incidence_cosine
from ..maps.representation import Representation, representation
from ..resample import resample
from .ball_circle import Circle
from .exposure.motion import looked_up, pixel_points

SHARPNESS = 4.0
"""Power of a ball's resolution that is its weight: the sharper ball shows, and changes are smooth."""

FAINT = 1e-6
"""Relative weight of the camera's reflection: it shows only where no other ball shows anything."""


@dataclass(frozen=True, eq=False)
class BallSide:
    """A photograph of a ball, and the place of its camera.

    Attributes
    ----------
    picture : ndarray, shape (size, size, 3)
        Radiance; the square touches the ball's outline. Row 0 at the bottom.
    turn : float
        Angle of the camera around the ball, counterclockwise seen from above; at 0 it looks along +Y [rad].
    elevation : float
        Angle by which it looked down on the ball, in (-pi/2, pi/2) [rad].
    distance : float
        From the ball's centre to the camera, in radii of the ball; infinite for a camera far away.
    """

    picture: Array
    turn: float = 0.0
    elevation: float = 0.0
    distance: float = np.inf

    @property
    def representation(self) -> Representation:
        """The layout of `picture` in the world.

        Raises
        ------
        RangeError
            The camera is inside the ball.
        """
        level = np.cos(self.elevation)
        towards = (np.sin(self.turn) * level, -np.cos(self.turn) * level, np.sin(self.elevation))
        return replace(representation("mirror_ball", distance=self.distance), frame=camera_frame(towards))


def distance_from_view(circle: Circle, side: float, field_of_view: float) -> float:
    """Distance of a camera from a ball, from the ball's size in its photograph.

    Parameters
    ----------
    circle : Circle
        The ball's outline, near the photograph's middle.
    side : float
        Longer side of the photograph as the camera took it [pixels].
    field_of_view : float
        Full angle that this side shows, in (0, pi) [rad].

    Returns
    -------
    float
        Distance from the ball's centre, in its radii. The line of sight that touches the ball is at the angle
        arcsin(1 / distance) from the line through its centre.
    """
    focal_length = 0.5 * side / np.tan(0.5 * field_of_view)
    return float(np.hypot(1.0, focal_length / circle.radius))


def cut_ball(photograph: Array, circle: Circle, size: int) -> Array:
    """The square around a ball.

    Parameters
    ----------
    photograph : ndarray, shape (height, width, 3)
    circle : Circle
    size : int
        Width and height of the square [pixels].

    Returns
    -------
    ndarray, shape (size, size, 3), float64
        Interpolated bilinearly; beyond the photograph its edge is repeated.
    """
    height, width = photograph.shape[:2]
    middle = complex(circle.x - 0.5 * width, circle.y - 0.5 * height)
    return looked_up(photograph, middle + 2.0 * circle.radius / size * pixel_points(size, size))


def without_reflectance(picture: Array, distance: float, reflectance: ArrayLike) -> Array:
    """The light that a ball reflects, of what it shows: [Miller1984] section 5.1's colour correction.

    Parameters
    ----------
    picture : ndarray, shape (size, size, 3)
        The square that touches the ball's outline.
    distance : float
        From the ball's centre to the camera, in radii of the ball.
    reflectance : array_like, shape (3,)
        Of the ball at normal incidence, in (0, 1].

    Returns
    -------
    ndarray, shape (size, size, 3)
        The picture over Schlick's term for the angle at which each point is seen, which is 1 at the outline.
    """
    uv = texel_centres(len(picture), len(picture))
    without: Array = picture / fresnel_schlick(incidence_cosine(uv, distance)[..., None], reflectance)
    return without


def environment_from_balls(sides: Sequence[BallSide], size: int, camera_angle: float) -> tuple[Array, Array]:
    """Unwrap photographs of a ball from one or more sides, and merge them.

    Parameters
    ----------
    sides : sequence of BallSide
    size : int
        Width of the environment in texels, even.
    camera_angle : float
        Half-angle of the cone about a camera's direction that shows the reflection of the camera and of its
        user [rad], from 0.

    Returns
    -------
    radiance : ndarray, shape (size / 2, size, 3), float64
        A latitude-longitude map, in the first photograph's scale.
    gains : ndarray, shape (sides,)
        Factors that made the photographs agree with the first.

    Raises
    ------
    RangeError
        `size` is odd; a camera is inside the ball; or two photographs share nothing to compare
        their exposures by.

    Notes
    -----
    A distant camera sees equal solid angles in equal areas, but away from the camera these get narrow:
    across, the resolution is cos(alpha / 2) times that in the middle, alpha being the angle from the camera's
    direction. The weights are a power of that, which falls to 0 at the edge of the blind spot, and fade out
    towards the camera's own reflection.
    """
    equirect = representation("equirect")
    directions = equirect.texel_directions(size)[0]
    solid_angle = equirect.texel_solid_angle(size)[0]
    maps = [resample(side.picture[None], side.representation, equirect, size)[0] for side in sides]
    weights = [_weight(side.representation, directions, camera_angle) for side in sides]
    gains = np.ones(len(sides))
    for i in range(1, len(sides)):
        gains[i] = _gain(maps[0], maps[i], weights[0] * weights[i] * solid_angle)
    total = sum(
        gain * weight[..., None] * image for gain, weight, image in zip(gains, weights, maps, strict=True)
    )
    radiance: Array = total / np.sum(weights, axis=0)[..., None]
    return radiance, gains


def _weight(ball: Representation, directions: Array, camera_angle: float) -> Array:
    """Weight of a photograph in each direction, above 0."""
    angle = np.arccos(np.clip(dot(directions, ball.frame[:, 2]), -1.0, 1.0))
    shown = np.clip(angle / (np.pi - ball.blind_angle), 0.0, 1.0)
    fading = np.clip(angle / max(camera_angle, 1e-9) - 1.0, 0.0, 1.0)
    beside_camera = fading * fading * (3.0 - 2.0 * fading)
    weight: Array = np.cos(0.5 * np.pi * shown) ** SHARPNESS * np.maximum(beside_camera, FAINT)
    # In its blind spot a photograph repeats its outline: better than nothing
    return np.maximum(weight, FAINT * FAINT)


def _gain(first: Array, other: Array, weight: Array) -> float:
    """Median ratio of the first map to another, weighted."""
    brightness, other_brightness = first.sum(axis=-1), other.sum(axis=-1)
    usable = (weight > 1e-3 * weight.max()) & (brightness > 0.0) & (other_brightness > 0.0)
    if not np.any(usable):
        raise RangeError(
            "The photographs of the ball share nothing but black: expose them longer, or take them from "
            "nearer sides."
        )
    ratio, weight = brightness[usable] / other_brightness[usable], weight[usable]
    order = np.argsort(ratio, kind="stable")
    # With even weights two ratios may share the middle: their mean prefers neither
    below = np.cumsum(weight[order]) - 0.5 * weight[order]
    return float(np.interp(0.5 * weight.sum(), below, ratio[order]))
