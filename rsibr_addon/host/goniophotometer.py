"""A goniophotometer: a material's reflectance from one direction to another, by a sun.

A sun without extent and an orthographic camera make one pair of directions; only the surface between them
changes from tile to tile. Cycles evaluates all closures of a material for such a sun, so each pixel is the
reflectance itself, without noise.
"""

import bpy
import numpy as np
from mathutils import Matrix

from ..core.conventions import Array
from ..core.geometry.camera import Camera
from ..core.geometry.directions import camera_frame, dot
from .cameras import add_camera
from .rendering import configure_cycles, render_passes
from .working_space import rec709_from_working

SAMPLES = 4
"""Cycles' samples per tile; they differ only where a material depends on the place."""

FILTER = 0.2
"""Width of the pixel filter in pixels, so that no sample falls on a tile's neighbour."""

HALF_FRAME = 0.1
"""Half the width that the camera sees: in a small frame tiles are small, and steep ones do not reach the
camera."""

LEAST_COSINE = 1e-3
"""Least cosine between a tile's normal and the view or the light: a steeper tile could reach the camera."""

VIEW = Camera((0.0, 0.0, 1.0))


def measure(
    scene: bpy.types.Scene, material: bpy.types.Material, light_dir: Array, view_dir: Array
) -> tuple[Array, Array]:
    """Measure a material's reflectance for pairs of directions that enclose one angle.

    Parameters
    ----------
    scene : bpy.types.Scene
        An empty `temporary_scene`.
    material : bpy.types.Material
    light_dir, view_dir : ndarray, shape (N, 3)
        Unit vectors; the surface's normal is +Z, to which both have a cosine of at least `LEAST_COSINE`. All
        pairs enclose the same angle.

    Returns
    -------
    diffuse, glossy : ndarray, shape (N, 3), float64
        [1/sr] in linear Rec. 709, of the closures that Cycles calls diffuse and of those that it calls
        glossy. Mirrors without roughness, transmitted light and emission are not included.

    Raises
    ------
    RenderError
        Cycles did not deliver.
    """
    size = int(np.ceil(np.sqrt(len(light_dir))))
    _add_sun(scene, float(dot(light_dir[0], view_dir[0])))
    _add_tiles(scene, material, _normals(light_dir, view_dir), size)
    add_camera(scene, VIEW).data.ortho_scale = 2.0 * HALF_FRAME
    configure_cycles(scene, size, size, SAMPLES)
    scene.cycles.transparent_max_bounces = 0  # light that passes through a tile meets no other
    scene.cycles.pixel_filter_type, scene.cycles.filter_width = "BLACKMAN_HARRIS", FILTER
    layer = scene.view_layers[0]
    for part in ("diffuse", "glossy"):
        setattr(layer, f"use_pass_{part}_direct", True)
        setattr(layer, f"use_pass_{part}_color", True)
    passes = {name: pixels.astype(np.float64) for name, pixels in render_passes(scene).items()}
    diffuse, glossy = (
        rec709_from_working(passes[f"{part} Direct"] * passes[f"{part} Color"]).reshape(-1, 3)
        for part in ("Diffuse", "Glossy")
    )
    cosine = light_dir[:, 2:]
    return diffuse[: len(cosine)] / cosine, glossy[: len(cosine)] / cosine


def _normals(light_dir: Array, view_dir: Array) -> Array:
    """Each pair's surface normal in the camera's axes, with the light in their x-z plane, towards x.

    They are a rotation that takes the view to z and the light to that plane, times +Z.
    """
    x = light_dir - dot(light_dir, view_dir)[:, None] * view_dir
    length = np.linalg.norm(x, axis=1, keepdims=True)
    # Where light and view are equal, any plane contains them.
    x = np.where(length > 1e-9, x / np.maximum(length, 1e-9), camera_frame(view_dir)[..., 0])
    return np.stack([x[:, 2], np.cross(view_dir, x)[:, 2], view_dir[:, 2]], axis=-1)


def _add_sun(scene: bpy.types.Scene, cosine: float) -> None:
    """A sun of irradiance 1, at an angle from the camera that is given by its cosine."""
    sun = bpy.data.lights.new("RSIBR sun", "SUN")
    sun.energy, sun.angle, sun.use_shadow = 1.0, 0.0, False
    item = bpy.data.objects.new("RSIBR sun", sun)
    # A sun's own z axis points at it.
    towards = VIEW.frame @ (np.sqrt(max(1.0 - cosine**2, 0.0)), 0.0, cosine)
    item.matrix_world = Matrix(camera_frame(towards)).to_4x4()
    scene.collection.objects.link(item)


def _unsampled(material: bpy.types.Material) -> bpy.types.Material:
    """A copy that Cycles does not take for a lamp where it glows: the sun must be the only one."""
    copy = material.copy()
    copy.cycles.emission_sampling = "NONE"
    return copy


def _add_tiles(scene: bpy.types.Scene, material: bpy.types.Material, normals: Array, size: int) -> None:
    """A tile over each pixel of a square picture, row by row from the bottom."""
    index = np.arange(len(normals))
    middle = HALF_FRAME * ((np.stack([index % size, index // size], axis=-1) + 0.5) * (2.0 / size) - 1.0)
    offsets = HALF_FRAME * np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]) / size
    drop = -(normals[:, None, :2] @ offsets.T)[:, 0] / normals[:, 2:]
    corners = np.concatenate([middle[:, None] + offsets, drop[..., None]], axis=-1)
    mesh = bpy.data.meshes.new("RSIBR tiles")
    vertices = corners.reshape(-1, 3) @ VIEW.frame.T
    mesh.from_pydata(vertices.tolist(), [], np.arange(len(vertices)).reshape(-1, 4).tolist())
    mesh.materials.append(_unsampled(material))
    tiles = bpy.data.objects.new("RSIBR tiles", mesh)
    # No tile takes light from another.
    tiles.visible_diffuse = tiles.visible_glossy = tiles.visible_transmission = tiles.visible_shadow = False
    scene.collection.objects.link(tiles)
