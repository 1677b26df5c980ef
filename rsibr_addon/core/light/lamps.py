"""Lamps in an environment: sources too small to be sampled, as energy in the texels that hold them.

[Miller1984] section 5.2: "For each point source, determine its direction and add the energy divided by
distance squared into the illumination table."
"""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from ..conventions import Array, ArrayLike
from ..errors import RangeError
from ..geometry.directions import camera_frame, normalize
from ..maps import equirect
from ..ties import TIE

GOLDEN_ANGLE = np.pi * (3.0 - np.sqrt(5.0))
"""Turn from one seed of a sunflower to the next [rad]."""


@dataclass(frozen=True)
class LampLight:
    """The light of a lamp as it arrives at a point.

    Attributes
    ----------
    directions : ndarray, shape (count, 3)
        Unit directions to equal parts of the lamp; one is enough for a point.
    irradiance : ndarray, shape (3,)
        Irradiance on a surface that faces the whole lamp; for a point, its radiant intensity over distance
        squared.
    """

    directions: Array
    irradiance: Array


def directions_in_cap(axis: ArrayLike, half_angle: float, count: int) -> Array:
    """Directions spread evenly over a cap of the sphere, such as a round lamp covers.

    Parameters
    ----------
    axis : array_like, shape (3,)
        Unit direction of the cap's middle.
    half_angle : float
        [rad], in [0, pi].
    count : int
        At least 1.

    Returns
    -------
    ndarray, shape (count, 3), float64
        Unit directions in a sunflower's order, each for an equal solid angle.

    Raises
    ------
    RangeError
        `half_angle` or `count` is out of range.
    """
    if not 0.0 <= half_angle <= np.pi or count < 1:
        raise RangeError("A cap takes a half-angle from 0 to 180 degrees and at least one direction.")
    seed = np.arange(count) + 0.5
    # 1 - cos is proportional to the solid angle within; as a square it keeps its digits.
    rise = 2.0 * np.sin(0.5 * half_angle) ** 2 * seed / count
    radius = np.sqrt(rise * (2.0 - rise))
    turn = GOLDEN_ANGLE * seed
    local = np.stack([radius * np.cos(turn), radius * np.sin(turn), 1.0 - rise], axis=-1)
    spread: Array = local @ camera_frame(axis).T
    return spread


def angular_width(directions: ArrayLike) -> float:
    """Angular width of a lamp.

    Parameters
    ----------
    directions : array_like, shape (count, 3)
        Unit directions to parts of the lamp.

    Returns
    -------
    float
        [rad]; twice the largest angle to their mean, up to 2 pi. Directions all around have no mean and get 2
        pi.
    """
    parts: Array = np.asarray(directions, dtype=np.float64)
    total = parts.sum(axis=0)
    if np.linalg.norm(total) < 1e-6 * len(parts):
        return 2.0 * np.pi
    # By the chord, as the arc cosine of almost 1 has no digits.
    chord = np.linalg.norm(parts - normalize(total), axis=-1).max()
    return float(4.0 * np.arcsin(min(0.5 * chord, 1.0)))


def add_lamps(radiance: Array, lamps: Iterable[LampLight]) -> Array:
    """Add lamps to a latitude-longitude map.

    Parameters
    ----------
    radiance : ndarray, shape (height, width, 3)
        All other light.
    lamps : iterable of LampLight

    Returns
    -------
    ndarray, shape (height, width, 3), float64
        With the irradiance of each part of each lamp, divided by the solid angle of the texel that holds it.
        This radiance over the texel gives that irradiance, and so does any filtered map.
    """
    height, width = radiance.shape[:2]
    energy = np.zeros((height * width, 3))
    for lamp in lamps:
        uv = equirect.uv_from_direction(lamp.directions)
        column = np.minimum((uv[:, 0] * width + TIE).astype(np.intp), width - 1)
        row = np.minimum((uv[:, 1] * height + TIE).astype(np.intp), height - 1)
        np.add.at(energy, row * width + column, np.asarray(lamp.irradiance) / len(uv))
    added: Array = energy.reshape(height, width, 3) / equirect.texel_solid_angle(width, height)[..., None]
    return radiance + added
