"""Surroundings that are near: a box or a ball stands for the room that a map was captured in.

A map holds the light of one point. Seen from another point, the same wall lies in another direction. Where
the walls are known, about, the map is looked up where the reflected ray meets them.
"""

from enum import StrEnum

import numpy as np

from ..conventions import Array, ArrayLike
from .directions import normalize

LEAST_WAY = 1e-6
"""The shortest way of a ray, so that one from the point of capture has a direction."""


class Room(StrEnum):
    """What stands for the surroundings.

    DISTANT surroundings look the same from everywhere. BOX is a box along the axes, SPHERE an ellipsoid.
    """

    DISTANT = "distant"
    BOX = "box"
    SPHERE = "sphere"


def near_direction(
    position: ArrayLike, direction: ArrayLike, room: Room, half_size: ArrayLike, middle: ArrayLike
) -> Array:
    """Where a map shows what a ray meets.

    Parameters
    ----------
    position : array_like, shape (..., 3)
        Where the ray starts, relative to the point that the map was captured at.
    direction : array_like, shape (..., 3)
        Unit vectors.
    room : Room
    half_size : array_like, shape (3,)
        Half of the room's widths, above 0.
    middle : array_like, shape (3,)
        The room's middle, relative to the point that the map was captured at.

    Returns
    -------
    ndarray, shape (..., 3), float64
        Unit vectors from that point. They are `direction` in distant surroundings. From outside, as through a
        door, a ray is followed to where it leaves the room, or no farther than its start: so light does not
        jump at the room's border.

    Notes
    -----
    GLSL twin: gpu_shaders/lib/near_room_lib.glsl, 1e-5.
    """
    if room is Room.DISTANT:
        return np.asarray(direction, np.float64)
    position, direction = np.broadcast_arrays(
        np.asarray(position, np.float64), np.asarray(direction, np.float64)
    )
    half_size = np.asarray(half_size, np.float64)
    start, ray = (position - middle) / half_size, direction / half_size
    if room is Room.BOX:
        size = np.maximum(np.abs(ray), 1e-20)
        along = np.min((1.0 - start * np.sign(ray)) / size, axis=-1)
    else:
        a, b, c = (np.sum(x * y, axis=-1) for x, y in ((ray, ray), (start, ray), (start, start)))
        along = (np.sqrt(np.maximum(b**2 - a * (c - 1.0), 0.0)) - b) / a
    return normalize(position + np.maximum(along, LEAST_WAY)[..., None] * direction)


def outside_distance(place: ArrayLike, room: Room, half_size: ArrayLike) -> Array:
    """How far places are from a room.

    Parameters
    ----------
    place : array_like, shape (..., 3)
        Relative to the room's middle.
    room : Room
        BOX or SPHERE.
    half_size : array_like, shape (3,)
        Half of the room's widths, above 0.

    Returns
    -------
    ndarray, shape (...), float64
        0 inside. Of an ellipsoid the way beyond it is measured along the line to its middle.

    Notes
    -----
    GLSL twin: gpu_shaders/lib/near_room_lib.glsl, 1e-5.
    """
    place, half_size = np.asarray(place, np.float64), np.asarray(half_size, np.float64)
    if room is Room.BOX:
        beyond = np.maximum(np.abs(place) - half_size, 0.0)
        return np.asarray(np.linalg.norm(beyond, axis=-1))
    size = np.linalg.norm(place / half_size, axis=-1)
    return np.asarray(np.linalg.norm(place, axis=-1) * np.maximum(1.0 - 1.0 / np.maximum(size, 1e-20), 0.0))
