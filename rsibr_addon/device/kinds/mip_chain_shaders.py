"""Interface of the GPU program of mip chains; its sources are in `gpu_shaders`."""

import numpy as np

from ...core.conventions import Array
from ...core.geometry.near_room import Room
from ...core.kinds.mip_chain.mip_lobes import MipLobes
from ...core.kinds.mip_chain.probes import Place
from ...core.kinds.mip_chain.shading import Borders, MipLook
from ..shaders import MeshProgram

mip_chain_shader = MeshProgram(
    "mip_chain",
    "MipLook look",
    "vec4 f0; vec4 kd; float level; float last_level; float clamped; float antialiased;"
    "vec4 room; vec4 middle; vec4 captured_at;",
    {"atlas": "FLOAT_2D", "harmonics": "FLOAT_2D", "places": "FLOAT_2D"},
)
"""Draws a mesh from a mip chain."""


def look_fields(look: MipLook, lobes: MipLobes, probes: int = 0) -> tuple[Array, ...]:
    """A look of a chain with these lobes and so many probes, as `buffers.KeptBlock` takes it.

    Raises
    ------
    RangeError
        See `MipLook.level` and `MipLook.diffuse_level`.
    """
    clamped = look.borders is Borders.CLAMPED
    numbers = np.array([look.level(lobes), lobes.count - 1.0, float(clamped), float(look.antialiased)])
    room, middle, _ = place_rows(look.place)
    if probes or look.room is not Room.DISTANT:
        middle[3] = look.diffuse_level(lobes)
    return np.array(look.f0), np.array(look.kd), numbers, room, middle, np.array([*look.captured_at, probes])


def place_rows(place: Place) -> Array:
    """A place as gpu_shaders/lib/probes_lib.glsl reads it, shape (3, 4)."""
    return np.array(
        [
            [*place.half_size, list(Room).index(place.room)],
            [*place.near_middle, place.blend],
            [*place.captured_at, 0.0],
        ]
    )
