"""The white furnace: a material's reflection of uniform light to each side."""

import bpy
import numpy as np

from ..core.conventions import Array
from ..core.environment import Environment
from ..core.geometry.camera import Camera
from .cameras import add_camera
from .cycles import RenderSettings, render_view
from .worlds import light_with

COSINES = 64
"""Rows of tiles, each at its own cosine to the view: (k + 0.5) / COSINES."""

STRIPS = 8
"""Tiles per cosine: the steepest one must not reach the camera."""

SAMPLES = 256
"""Cycles' samples per pixel. Each cosine is the mean of COSINES pixels: a coat over a base is noisy, as each
sample takes one of the two."""


def directional_albedo(scene: bpy.types.Scene, material: bpy.types.Material, seed: int) -> Array:
    """Measure a material's directional albedo in Cycles, its diffuse and its glossy part apart.

    Parameters
    ----------
    scene : bpy.types.Scene
        An empty `temporary_scene`.
    material : bpy.types.Material
    seed : int

    Returns
    -------
    ndarray, shape (2, COSINES, 3), float32
        Reflected over incoming radiance under uniform light; diffuse in row 0, glossy in row 1;
        column k is for n.v = (k + 0.5) / COSINES. Emission counts as diffuse.

    Raises
    ------
    RenderError
        Cycles did not deliver.
    """
    light_with(scene, Environment(np.ones((1, 2, 3), dtype=np.float32), "white"))
    _add_fan(scene, material)
    add_camera(scene, Camera((0.0, 0.0, 1.0)))
    seen = render_view(scene, RenderSettings(COSINES, SAMPLES, seed=seed))
    return np.stack([seen.diffuse.mean(axis=0), seen.glossy.mean(axis=0)])


def _add_fan(scene: bpy.types.Scene, material: bpy.types.Material) -> None:
    """Tiles over the frame of an orthographic camera above, each more tilted from right to left.

    Only the camera sees them: no tile takes light from another.
    """
    tiles = COSINES * STRIPS
    cosine = (np.arange(tiles) // STRIPS + 0.5) / COSINES
    left = -1.0 + 2.0 * np.arange(tiles) / tiles
    right = left + 2.0 / tiles
    drop = (right - left) * np.sqrt(1.0 - cosine**2) / cosine
    corners = np.stack(
        [
            np.stack([x, np.full(tiles, y), z], axis=-1)
            for x, y, z in (
                (left, -1.0, 0.5 * drop),
                (right, -1.0, -0.5 * drop),
                (right, 1.0, -0.5 * drop),
                (left, 1.0, 0.5 * drop),
            )
        ],
        axis=1,
    )
    # The camera's axes in the world are its frame: camera coordinates to world coordinates.
    corners = corners.reshape(-1, 3) @ Camera((0.0, 0.0, 1.0)).frame.T
    mesh = bpy.data.meshes.new("RSIBR fan")
    mesh.from_pydata(corners.tolist(), [], np.arange(4 * tiles).reshape(-1, 4).tolist())
    mesh.materials.append(material)
    fan = bpy.data.objects.new("RSIBR fan", mesh)
    fan.visible_diffuse = fan.visible_glossy = fan.visible_transmission = fan.visible_shadow = False
    scene.collection.objects.link(fan)
