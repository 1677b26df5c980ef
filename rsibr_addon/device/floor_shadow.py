"""The diffuse shadow of a mesh on a floor: a shadow for each of many lamps, added up."""

import gpu
import numpy as np

from ..core.conventions import Array, Indices
from ..core.light.median_cut import Lamps
from ..core.pictures.matte import EXTENT, flattened
from . import buffers
from .context import ensure_context
from .drawing import Draw, GpuMesh
from .shaders import MeshProgram

floor_shadow_shader = MeshProgram("floor_shadow", "Lamp lamp", "vec4 irradiance;", {})
"""Draws the shadow of a mesh."""


def floor_shadow(positions: Array, triangles: Indices, height: float, lamps: Lamps, size: int) -> Array:
    """The irradiance that a mesh takes from a floor.

    Parameters
    ----------
    positions : ndarray, shape (V, 3)
        A mesh above the floor, in world coordinates.
    triangles : ndarray of int, shape (F, 3)
    height : float
        The floor's z.
    lamps : Lamps
    size : int
        Width of the map in texels.

    Returns
    -------
    ndarray, shape (size, size, 3), float32
        A map of the floor, `core.pictures.matte.EXTENT` around the origin, row 0 at the least y.

    Raises
    ------
    DeviceError
        There is no graphics driver, or it refuses the program.

    Notes
    -----
    All of a lamp's shadow has one depth, so that only its first triangle counts at each texel.
    """
    ensure_context()
    shadow = buffers.render_target(size)
    depth = gpu.types.GPUTexture((size, size), format="DEPTH_COMPONENT32F")
    target = gpu.types.GPUFrameBuffer(depth_slot=depth, color_slots=(shadow,))
    shader = floor_shadow_shader()
    mesh = GpuMesh(positions, np.zeros_like(positions), triangles)
    block = buffers.KeptBlock()
    above = np.diag([1.0 / EXTENT, 1.0 / EXTENT, 1.0, 1.0])
    kept = gpu.state.depth_test_get(), gpu.state.depth_mask_get(), gpu.state.blend_get()
    with target.bind():
        target.clear(color=(0.0, 0.0, 0.0, 0.0), depth=1.0)
        gpu.state.depth_test_set("LESS")
        gpu.state.depth_mask_set(True)
        gpu.state.blend_set("ADDITIVE")
        try:
            for direction, irradiance in zip(lamps.directions, lamps.irradiance, strict=True):
                target.clear(depth=1.0)
                shader.bind()
                shader.uniform_block("lamp", block.filled(irradiance))
                view = flattened(direction, height)
                mesh.draw(shader, Draw(np.eye(4), view, above, np.array([0.0, 0.0, 1.0, 0.0])))
        finally:
            gpu.state.depth_test_set(kept[0])
            gpu.state.depth_mask_set(kept[1])
            gpu.state.blend_set(kept[2])
        return buffers.pixels(target, size)[..., :3]
