"""Meshes to shade: from Blender's objects, from files, and two that are built in.

A shader wants one position and one normal per vertex, Blender keeps normals per face corner: where
corners at a vertex disagree, the vertex is split.
"""

import hashlib
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import bpy

# isort: split
import bmesh  # exists, outside Blender, once bpy is imported
import numpy as np

from ..core.conventions import Array, Indices
from ..core.errors import InputFileError, SceneError
from .mesh_arrays import (
    bits,
    corner_vertices,
    drawn_normals,
    has_sound_triangles,
    read_property,
    split_vertices,
    triangle_corners,
    vertex_positions,
)
from .scenes import temporary_scene

MESH_NAMES = ("sphere", "monkey")
"""Meshes that `load_mesh` makes itself; any other name is a file."""

MESH_FILES: dict[str, Callable[..., Any]] = {
    ".obj": partial(bpy.ops.wm.obj_import, validate_meshes=False),
    ".ply": bpy.ops.wm.ply_import,
    ".stl": partial(bpy.ops.wm.stl_import, use_mesh_validate=False),
}
"""Ending of a file that `load_mesh` reads -> Blender's operator for it, which hides no faults."""

SPHERE_RINGS = 160
"""Bands of latitude of the tessellated sphere, which has twice as many meridians.

No point of the sphere is further than half a cell's diagonal, pi / (160 sqrt 2) rad, from a
vertex, so neither the surface nor the silhouette sags by more than 1 - cos of that: 9.7e-5.
"""

MONKEY_SUBDIVISIONS = 3
"""Levels of Suzanne's subdivision surface: 62,976 triangles."""

ROW_STEP = 2.1
"""From one mesh of a row to the next, in radii."""


@dataclass(frozen=True)
class TriangleMesh:
    """Triangles with smooth normals, ready for upload.

    Attributes
    ----------
    name : str
        Its name for reports.
    positions : ndarray, shape (V, 3), float32
    normals : ndarray, shape (V, 3), float32
        Unit vectors.
    triangles : ndarray, shape (T, 3), int32
        Vertex indices, counter-clockwise seen from outside.
    """

    name: str
    positions: Array
    normals: Array
    triangles: Indices


def load_mesh(spec: str) -> TriangleMesh:
    """The mesh of a command's ``--mesh``, within the unit sphere about the origin.

    Parameters
    ----------
    spec : str
        ``sphere``: the unit sphere. ``monkey``: Suzanne, subdivided. Otherwise the path of a
        file of `MESH_FILES`: Wavefront OBJ, whose Y up becomes Blender's Z up and whose objects become one
        mesh; PLY or STL, whose axes are Blender's. A file that states neither normals nor smoothing groups
        is shaded smooth.

    Returns
    -------
    TriangleMesh
        All but the sphere are moved so that the centre of their bounding box is the origin, and
        scaled so that the vertex farthest from it lies on the unit sphere.

    Raises
    ------
    InputFileError
        The file is missing or of another format, has no faces or no extent, or has positions that are not
        finite.
    """
    if spec == "sphere":
        return _sphere()
    if spec == "monkey":
        return _fitted(_monkey())
    return _fitted(_read_mesh(Path(spec)))


def mesh_row(specs: Sequence[str]) -> TriangleMesh:
    """Meshes of `load_mesh` beside each other along X, as one within the unit sphere.

    Raises
    ------
    InputFileError
        As `load_mesh`.
    """
    if len(specs) == 1:
        return load_mesh(specs[0])
    meshes = [load_mesh(spec) for spec in specs]
    first = np.cumsum([0, *(len(mesh.positions) for mesh in meshes)])
    along = np.array([ROW_STEP, 0.0, 0.0], np.float32)
    moved = [mesh.positions + place * along for place, mesh in enumerate(meshes)]
    triangles = [mesh.triangles + np.int32(start) for mesh, start in zip(meshes, first[:-1], strict=True)]
    normals = np.concatenate([mesh.normals for mesh in meshes])
    name = " and ".join(mesh.name for mesh in meshes)
    return _fitted(TriangleMesh(name, np.concatenate(moved), normals, np.concatenate(triangles)))


def mesh_from_object(item: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> TriangleMesh:
    """An object's surface as it is drawn: modifiers applied, smooth and custom normals kept.

    Parameters
    ----------
    item : bpy.types.Object
        Object of any type that Blender can turn into a mesh.
    depsgraph : bpy.types.Depsgraph
        Evaluated, and holding `item`.

    Returns
    -------
    TriangleMesh
        In the object's own coordinates. Without faces it has no triangles.

    Raises
    ------
    SceneError
        The object has no geometry: a light, a camera, an empty.
    """
    with evaluated_mesh(item, depsgraph) as mesh:
        return triangle_mesh(mesh, item.name)


def mesh_of_objects(items: Sequence[bpy.types.Object], depsgraph: bpy.types.Depsgraph) -> TriangleMesh:
    """Objects as one mesh, as they stand to each other, fitted into the unit sphere.

    Parameters are those of `mesh_from_object`; the name is that of the first object.

    Raises
    ------
    SceneError
        One has no geometry, or all have no faces.
    InputFileError
        They have no extent.
    """
    mesh = _joined(items[0].name, items, depsgraph)
    if not len(mesh.triangles):
        raise SceneError(f"{mesh.name} has no faces to show: choose a mesh with faces.")
    return _fitted(mesh)


@contextmanager
def evaluated_mesh(item: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> Iterator[bpy.types.Mesh]:
    """An object's mesh as it is drawn, for as long as the context lasts.

    Parameters and errors are those of `mesh_from_object`.
    """
    evaluated = item.evaluated_get(depsgraph)
    try:
        mesh = evaluated.to_mesh()
    except RuntimeError as error:
        raise SceneError(f"{item.name} has no surface to shade: choose a mesh object.") from error
    try:
        yield mesh
    finally:
        evaluated.to_mesh_clear()


def content_of(mesh: bpy.types.Mesh) -> bytes:
    """A hash of all data that `triangle_mesh` depends on, in a fraction of its time."""
    arrays = (
        vertex_positions(mesh),
        corner_vertices(mesh),
        drawn_normals(mesh),
        read_property(mesh.polygons, "loop_start", np.int32),
    )
    content = hashlib.sha1(mesh.normals_domain.encode(), usedforsecurity=False)
    for array in arrays:
        content.update(len(array).to_bytes(8))
        content.update(array.data)
    return content.digest()


def add_mesh(scene: bpy.types.Scene, mesh: TriangleMesh, material: bpy.types.Material) -> bpy.types.Object:
    """Put a mesh into a scene, with exactly its vertices and normals."""
    data = bpy.data.meshes.new(mesh.name)
    data.vertices.add(len(mesh.positions))
    data.vertices.foreach_set("co", mesh.positions.ravel())
    data.loops.add(mesh.triangles.size)
    data.loops.foreach_set("vertex_index", mesh.triangles.ravel())
    data.polygons.add(len(mesh.triangles))
    data.polygons.foreach_set("loop_start", np.arange(0, mesh.triangles.size, 3, dtype=np.int32))
    # Blender keeps normals exactly as a float attribute; its usual int16 encoding rounds them.
    normals = data.attributes.new("custom_normal", "FLOAT_VECTOR", "POINT")
    normals.data.foreach_set("vector", mesh.normals.ravel())
    data.update(calc_edges=True)
    data.materials.append(material)
    item = bpy.data.objects.new(mesh.name, data)
    scene.collection.objects.link(item)
    return item


def _sphere() -> TriangleMesh:
    rings, sectors = SPHERE_RINGS, 2 * SPHERE_RINGS
    theta = np.pi * np.arange(rings + 1) / rings
    phi = 2.0 * np.pi * np.arange(sectors) / sectors
    x, y = np.outer(np.sin(theta), np.cos(phi)), np.outer(np.sin(theta), np.sin(phi))
    z = np.broadcast_to(np.cos(theta)[:, None], x.shape)
    positions = np.stack([x, y, z], axis=-1).reshape(-1, 3).astype(np.float32)
    vertex = np.arange(positions.shape[0]).reshape(rings + 1, sectors)
    eastwards = np.roll(vertex, -1, axis=1)
    left = np.stack([vertex[:-1], vertex[1:], eastwards[1:]], axis=-1)
    right = np.stack([vertex[:-1], eastwards[1:], eastwards[:-1]], axis=-1)
    # At a pole, where a ring is one point, one of a cell's two triangles is empty.
    triangles = np.concatenate([left[:-1].reshape(-1, 3), right[1:].reshape(-1, 3)])
    return TriangleMesh("sphere", positions, positions, triangles.astype(np.int32))


def _monkey() -> TriangleMesh:
    with temporary_scene() as scene:
        data = bpy.data.meshes.new("monkey")
        suzanne = bmesh.new()
        bmesh.ops.create_monkey(suzanne)
        suzanne.to_mesh(data)
        suzanne.free()
        data.shade_smooth()
        item = bpy.data.objects.new("monkey", data)
        scene.collection.objects.link(item)
        subdivision = item.modifiers.new("Subdivision", "SUBSURF")
        subdivision.levels = MONKEY_SUBDIVISIONS
        return _joined_scene("monkey", scene)


def _read_mesh(path: Path) -> TriangleMesh:
    """All faces of a file, in Blender's axes."""
    if not path.is_file():
        names = " or ".join(MESH_NAMES)
        raise InputFileError(f"There is no mesh {path}: name {names}, or an existing file.")
    if path.suffix.lower() not in MESH_FILES:
        raise InputFileError(f"{path} is no OBJ, PLY or STL file by its name: save the mesh as one of them.")
    kind = path.suffix[1:].upper()
    with temporary_scene() as scene:
        try:
            with bpy.context.temp_override(scene=scene, view_layer=scene.view_layers[0]):
                MESH_FILES[path.suffix.lower()](filepath=str(path.resolve()))
        except (RuntimeError, UnicodeDecodeError) as error:  # Blender's report may quote bytes of the file
            raise InputFileError(f"{path} cannot be read as {kind}: check the file.") from error
        for item in scene.objects:
            if item.type == "MESH":
                _repair(item.data, path)
        mesh = _joined_scene(path.name, scene)
    if not len(mesh.triangles):
        raise InputFileError(f"{path} holds no faces that can be read as {kind}: give a file of a surface.")
    return mesh


def _repair(data: bpy.types.Mesh, path: Path) -> None:
    """Blender's own validation, without its hiding of faults, and normals for a file without any."""
    unusable = int(np.count_nonzero(~np.isfinite(read_property(data.vertices, "co", np.float32, 3))))
    if unusable:
        raise InputFileError(
            f"{path} holds {unusable} coordinates that are NaN or infinite: repair the mesh."
        )
    if not has_sound_triangles(data):  # told in a quarter of the time
        data.validate(clean_customdata=False)
    if data.normals_domain == "FACE" and not data.has_custom_normals:
        data.shade_smooth()


def _joined_scene(name: str, scene: bpy.types.Scene) -> TriangleMesh:
    """Everything in a scene as one mesh, in world coordinates."""
    scene.view_layers[0].update()
    return _joined(name, scene.objects, scene.view_layers[0].depsgraph)


def _joined(name: str, items: Iterable[bpy.types.Object], depsgraph: bpy.types.Depsgraph) -> TriangleMesh:
    """Objects as one mesh, in world coordinates."""
    positions: list[Array] = [np.empty((0, 3), np.float32)]
    normals: list[Array] = [np.empty((0, 3), np.float32)]
    triangles: list[Indices] = [np.empty((0, 3), np.int32)]
    count = 0
    for item in items:
        mesh = mesh_from_object(item, depsgraph)
        matrix = np.array(item.evaluated_get(depsgraph).matrix_world, np.float32)
        positions.append(mesh.positions @ matrix[:3, :3].T + matrix[:3, 3])
        # The cofactors, which a flat object has as well
        x, y, z = matrix[:3, :3]
        turned = mesh.normals @ np.array([np.cross(y, z), np.cross(z, x), np.cross(x, y)]).T
        mirrors = float(np.dot(x, np.cross(y, z))) < 0.0
        turned *= (-1.0 if mirrors else 1.0) / np.maximum(np.linalg.norm(turned, axis=1), 1e-30)[:, None]
        normals.append(turned.astype(np.float32))
        triangles.append(mesh.triangles[:, :: -1 if mirrors else 1] + np.int32(count))
        count += len(mesh.positions)
    return TriangleMesh(name, np.concatenate(positions), np.concatenate(normals), np.concatenate(triangles))


def _fitted(mesh: TriangleMesh) -> TriangleMesh:
    """Centre the bounding box and scale the farthest vertex onto the unit sphere."""
    low, high = (end(mesh.positions, axis=0).astype(np.float64) for end in (np.min, np.max))
    if np.array_equal(low, high):
        raise InputFileError(f"All vertices of {mesh.name} are one point: give a mesh with an extent.")
    # Before single precision could overflow in a square
    positions = (mesh.positions - (0.5 * (low + high)).astype(np.float32)) / np.float32((high - low).max())
    radius = np.sqrt(np.einsum("ij,ij->i", positions, positions).max())
    return replace(mesh, positions=positions / radius)


def triangle_mesh(mesh: bpy.types.Mesh, name: str) -> TriangleMesh:
    """A mesh's surface, its vertices split where corners' normals differ."""
    positions, normals, corners = vertex_positions(mesh), drawn_normals(mesh), triangle_corners(mesh)
    vertices = corner_vertices(mesh)[:, 0]
    if mesh.normals_domain == "POINT":
        return TriangleMesh(name, positions, normals, vertices[corners])
    kept, split = split_vertices(len(positions), vertices, bits(normals))
    return TriangleMesh(name, positions[vertices[kept]], normals[kept], split[corners])
