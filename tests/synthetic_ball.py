"""Photographs of a mirrored ball in an environment in closed form."""

import numpy as np
from rsibr.rsibr_addon.core.light.ball_circle import Circle
from rsibr.rsibr_addon.core.light.ball_photograph import BallSide

RNG = np.random.default_rng(5)
AXES = RNG.standard_normal((12, 3))
PHASES = RNG.uniform(0.0, 2.0 * np.pi, (12, 3))


def surroundings(directions: np.ndarray) -> np.ndarray:
    """Radiance from given directions, 0.1 to 2 or so, with details of some 15 degrees; shape (..., 3)."""
    waves = np.cos(3.0 * (directions @ AXES.T)[..., None] + PHASES)
    return np.exp(0.35 * waves.sum(axis=-2)) * 0.5


def ball_photograph(
    side: BallSide, circle: Circle, width: int, height: int, camera: float = 0.0
) -> np.ndarray:
    """A ball before a wall of another colour; a black camera shows in the ball's middle.

    `camera` is the half-angle of the directions that it hides [rad]; `side.picture` is not used.
    """
    x, y = np.arange(width) + 0.5, (np.arange(height) + 0.5)[:, None]
    picture = 0.25 + 0.2 * np.sin(0.31 * x) * np.cos(0.23 * y) * np.ones((height, width))
    picture = picture[..., None] * np.array([0.6, 0.5, 0.3])
    uv = np.stack(np.broadcast_arrays(x - circle.x, y - circle.y), axis=-1) / (2.0 * circle.radius) + 0.5
    ball = np.linalg.norm(uv - 0.5, axis=-1) < 0.5
    representation = side.representation
    directions = representation.direction_from_uv(uv[ball], np.zeros(np.count_nonzero(ball), dtype=np.intp))
    towards_camera = directions @ representation.frame[:, 2]
    shown = surroundings(directions)
    shown[towards_camera > np.cos(camera)] *= 0.01 if camera > 0.0 else 1.0
    picture[ball] = 0.8 * shown
    return picture
