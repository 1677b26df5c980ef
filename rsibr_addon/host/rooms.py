"""Objects of Blender that stand for rooms."""

from itertools import product

import bpy
import numpy as np

from ..core.geometry.near_room import Room


def room_of(item: bpy.types.Object) -> tuple[Room, tuple[float, float, float], tuple[float, float, float]]:
    """The room that an object stands for: the walls themselves, or an empty of the room's size.

    Parameters
    ----------
    item : bpy.types.Object

    Returns
    -------
    room : Room
        SPHERE of an empty that is displayed as one, else BOX.
    size, middle : tuple of float
        Of the box along the world's axes that holds it.
    """
    if item.type == "EMPTY":
        corners = item.empty_display_size * np.array([*product((-1.0, 1.0), repeat=3)])
    else:
        corners = np.array(item.bound_box)
    matrix = np.array(item.matrix_world)
    placed = corners @ matrix[:3, :3].T + matrix[:3, 3]
    low, high = placed.min(axis=0), placed.max(axis=0)
    is_sphere = item.type == "EMPTY" and item.empty_display_type == "SPHERE"
    size, middle = (high - low).tolist(), (0.5 * (low + high)).tolist()
    return Room.SPHERE if is_sphere else Room.BOX, tuple(size), tuple(middle)
