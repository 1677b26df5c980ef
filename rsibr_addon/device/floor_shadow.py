"""The diffuse shadow of meshes on a floor: a shadow for each of many lamps, added up.

Floors lie at z = 0 of coordinates of their own, with their light above.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import gpu
import numpy as np

from ..core.conventions import Array
from ..core.light.median_cut import Lamps
from ..core.pictures.matte import flattened
from . import buffers
from .drawing import Draw, GpuMesh
from .shaders import MeshProgram

floor_shadow_shader = MeshProgram("floor_shadow", "Lamp lamp", "vec4 irradiance;", {})
"""Draws the shadow of a mesh; what of it is below the floor has none."""

_FROM_ABOVE = np.array([0.0, 0.0, 1.0, 0.0])


@dataclass(frozen=True)
class FloorArea:
    """The square of a floor that shadows are caught on.

    Attributes
    ----------
    middle : ndarray, shape (2,)
    half_width : float
    """

    middle: Array
    half_width: float


def floor_shadow(
    casters: Sequence[tuple[GpuMesh, Array]], lamps: Lamps, area: FloorArea, size: int
) -> gpu.types.GPUTexture:
    """The irradiance that meshes take from a floor.

    Parameters
    ----------
    casters : sequence of (GpuMesh, ndarray of shape (4, 4))
        Each with the floor's coordinates from its own.
    lamps : Lamps
    area : FloorArea
    size : int
        Width of the map in texels.

    Returns
    -------
    GPUTexture, RGBA32F
        A map of the area, row 0 at the least y.

    Raises
    ------
    DeviceError
        The driver refuses the program.

    Notes
    -----
    All of a lamp's shadow has one depth, nearer than those of the lamps before, so that only its first
    triangle counts at each texel.
    """
    shadow = buffers.render_target(size)
    depth = gpu.types.GPUTexture((size, size), format="DEPTH_COMPONENT32F")
    target = gpu.types.GPUFrameBuffer(depth_slot=depth, color_slots=(shadow,))
    shader = floor_shadow_shader()
    block = buffers.KeptBlock()
    kept = gpu.state.depth_test_get(), gpu.state.depth_mask_get(), gpu.state.blend_get()
    with target.bind():
        target.clear(color=(0.0, 0.0, 0.0, 0.0), depth=1.0)
        gpu.state.depth_test_set("LESS")
        gpu.state.depth_mask_set(True)
        gpu.state.blend_set("ADDITIVE")
        try:
            pairs = zip(lamps.directions, lamps.irradiance, strict=True)
            for number, (direction, irradiance) in enumerate(pairs):
                view, projection = flattened(direction, 0.0), _above(area, number / len(lamps.directions))
                for mesh, model in casters:
                    shader.bind()
                    shader.uniform_block("lamp", block.filled(irradiance))
                    mesh.draw(shader, Draw(model, view, projection, _FROM_ABOVE))
        finally:
            gpu.state.depth_test_set(kept[0])
            gpu.state.depth_mask_set(kept[1])
            gpu.state.blend_set(kept[2])
    return shadow


def floor_map(shadow: gpu.types.GPUTexture) -> Array:
    """Read what `floor_shadow` made, shape (size, size, 3), float32."""
    target = gpu.types.GPUFrameBuffer(color_slots=(shadow,))
    with target.bind():
        return buffers.pixels(target, shadow.width)[..., :3]


def _above(area: FloorArea, nearness: float) -> Array:
    """From the floor to a map of an area; all is drawn as near as is said, from 0 to 1."""
    scale, (x, y) = 1.0 / area.half_width, area.middle
    return np.array(
        [
            [scale, 0.0, 0.0, -scale * x],
            [0.0, scale, 0.0, -scale * y],
            [0.0, 0.0, 0.0, 0.9 - 1.8 * nearness],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )
