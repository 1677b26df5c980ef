"""Interface of the GPU program of mip chains; its sources are in `gpu_shaders`."""

import numpy as np

from ...core.conventions import Array
from ...core.kinds.mip_chain.shading import Borders, MipLook
from ..shaders import MeshProgram

LOOK_FIELDS = "vec4 f0; vec4 kd; float level; float last_level; float clamped; float antialiased;"
"""Fields of a block that `look_fields` fills, also for harmonics on the GPU."""

mip_chain_shader = MeshProgram(
    "mip_chain",
    "MipLook look",
    f"mat4 irradiance_red; mat4 irradiance_green; mat4 irradiance_blue; {LOOK_FIELDS}",
    {"atlas": "FLOAT_2D"},
)
"""Draws a mesh from a mip chain."""


def look_fields(look: MipLook, level: float, mip_count: int) -> tuple[Array, ...]:
    """A look, as `buffers.KeptBlock` takes it.

    Parameters
    ----------
    look : MipLook
    level : float
        Level of detail, in [0, mip_count - 1].
    mip_count : int
        Number of the chain's mips.

    Returns
    -------
    tuple of ndarray
        Values of `LOOK_FIELDS`.
    """
    clamped = look.borders is Borders.CLAMPED
    numbers = np.array([level, mip_count - 1.0, float(clamped), float(look.antialiased)])
    return np.array(look.f0), np.array(look.kd), numbers
