"""Light that was captured in several rooms: which of it a point has, by where it is.

Engines do the same: each probe has a region with a border over which it fades.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...conventions import Array, ArrayLike
from ...geometry.near_room import Room, near_direction, outside_distance


@dataclass(frozen=True)
class Place:
    """Where a map was captured, and what stands for its surroundings.

    Attributes
    ----------
    captured_at : tuple of float
        World coordinates.
    room : Room
    size : tuple of float
        The room's widths along the axes.
    middle : tuple of float
        The room's, in world coordinates.
    blend : float
        Distance beyond the room's border at which its light is gone, above 0.
    """

    captured_at: tuple[float, float, float]
    room: Room
    size: tuple[float, float, float]
    middle: tuple[float, float, float]
    blend: float = 1.0

    @property
    def half_size(self) -> Array:
        """Half of the room's widths, shape (3,)."""
        return 0.5 * np.array(self.size)

    @property
    def near_middle(self) -> Array:
        """The room's middle, relative to where the map was captured, shape (3,)."""
        return np.array(self.middle) - self.captured_at

    def from_there(self, position: ArrayLike) -> Array:
        """Points in world coordinates, shape (..., 3), relative to where the map was captured."""
        return np.asarray(position, np.float64) - self.captured_at

    def near_direction(self, position: ArrayLike, direction: ArrayLike) -> Array:
        """`geometry.near_room.near_direction` in this room, of points in world coordinates, (..., 3)."""
        start = self.from_there(position)
        return near_direction(start, direction, self.room, self.half_size, self.near_middle)

    def weight(self, position: ArrayLike) -> Array:
        """How much of its light counts at points.

        Parameters
        ----------
        position : array_like, shape (..., 3)
            In world coordinates.

        Returns
        -------
        ndarray, shape (...), float64
            1 inside the room, falling to 0 at `blend` beyond its border.

        Notes
        -----
        GLSL twin: gpu_shaders/lib/probes_lib.glsl `probe_weight`, 1e-5.
        """
        beyond = outside_distance(np.asarray(position, np.float64) - self.middle, self.room, self.half_size)
        return np.asarray(np.clip(1.0 - beyond / self.blend, 0.0, 1.0))


@dataclass(frozen=True, eq=False)
class Probe:
    """Light of a room.

    Attributes
    ----------
    place : Place
        With a room that is near.
    mips : tuple of ndarray, shape (6, n, n, 3), float32
        Of the same sizes and lobes as those of the chain that it belongs to.
    """

    place: Place
    mips: tuple[Array, ...]


def shares(places: Sequence[Place], position: ArrayLike) -> tuple[Array, ...]:
    """How points share out between the light of no room and that of each room.

    Parameters
    ----------
    places : sequence of Place
    position : array_like, shape (..., 3)
        In world coordinates.

    Returns
    -------
    tuple of ndarray, shape (...)
        That of no room first; together 1. Where rooms overlap, their weights share alike.

    Notes
    -----
    GLSL twin: gpu_shaders/mip_chain_frag.glsl.
    """
    weights = [place.weight(position) for place in places]
    total = np.sum(weights, axis=0) if weights else np.zeros(np.shape(position)[:-1])
    return np.maximum(1.0 - total, 0.0), *(weight / np.maximum(total, 1.0) for weight in weights)
