"""The arrays of Blender's meshes, read without a Python loop."""

from typing import Any, TypeVar

import bpy
import numpy as np
from numpy.typing import NDArray

from ..core.conventions import Array, Indices

T = TypeVar("T", bound=np.generic)

KEYS_OF_MOST = 6
"""What hardly any vertex has more of: a sort, which is slow, is left for the others."""


def split_vertices(count: int, vertices: Indices, keys: Indices) -> tuple[Indices, Indices]:
    """One vertex for all corners that share a vertex and a key.

    Parameters
    ----------
    count : int
        Number of vertices before.
    vertices : ndarray of int32, shape (C,)
        Vertex of each corner.
    keys : ndarray of int32, shape (n, C)
        What a vertex may have one of, as the bits of a normal; column by column, for speed.

    Returns
    -------
    kept : ndarray, shape (V,)
        A corner for each new vertex.
    split : ndarray of int32, shape (C,)
        New vertex of each corner.
    """
    numbers = np.arange(len(vertices), dtype=np.int32)
    first, chosen, left = np.zeros(count, np.int32), np.zeros_like(numbers), numbers
    for _ in range(KEYS_OF_MOST):
        first[vertices[left[::-1]]] = left[::-1]  # of what is set more than once, the last value stays
        chosen[left] = first[vertices[left]]
        left = left[np.any(keys.take(left, axis=1) != keys.take(chosen[left], axis=1), axis=0)]
    _, kinds, kind_of_left = unique_rows(np.vstack([vertices[left], keys[:, left]]).T)
    chosen[left] = left[kinds][kind_of_left]
    is_kept = chosen == numbers
    new_number = np.cumsum(is_kept, dtype=np.int32) - np.int32(1)
    return np.flatnonzero(is_kept), new_number[chosen]


def numbered(rows: Array) -> Indices:
    """Numbers from 0, equal for equal rows, shape (N,), of rows of shape (N, n), float32."""
    numbers: Indices = unique_rows(bits(rows).T)[2].astype(np.int32)
    return numbers


def bits(values: Array) -> Indices:
    """Columns of single precision as rows of integers, equal where the values are, the zeros too."""
    rows: Indices = np.ascontiguousarray((values + np.float32(0.0)).T).view(np.int32)
    return rows


def unique_rows(rows: Indices) -> Any:
    """What `np.unique` says of rows, by one sort of long keys instead of one of each column."""
    keys = np.ascontiguousarray(rows).view(f"V{rows.shape[1] * rows.itemsize}").ravel()
    return np.unique(keys, return_index=True, return_inverse=True)


def triangle_slots(mesh: bpy.types.Mesh) -> Indices:
    """Material slot of each triangle, shape (T,); it may lie beyond the last one."""
    attribute = mesh.attributes.get("material_index")
    if attribute is None:  # all are 0
        return np.zeros(len(triangle_corners(mesh)), np.int32)
    slots = read_property(attribute.data, "value", np.int32)[:, 0]
    if _is_triangulated(mesh):
        return slots
    return slots[read_property(mesh.loop_triangle_polygons, "value", np.int32)[:, 0]]


def uv_map_named(mesh: bpy.types.Mesh, name: str) -> Any:
    """A UV map; the one that the mesh renders with for no name. None if there is none."""
    if name:
        return mesh.uv_layers.get(name)
    return next((each for each in mesh.uv_layers if each.active_render), None)


def corner_uv(mesh: bpy.types.Mesh, name: str) -> Array | None:
    """The places of `uv_map_named`, shape (corners, 2)."""
    uv_map = uv_map_named(mesh, name)
    return None if uv_map is None else read_property(uv_map.uv, "vector", np.float32, 2)


def triangle_corners(mesh: bpy.types.Mesh) -> Indices:
    """Corners of each triangle, shape (T, 3)."""
    if _is_triangulated(mesh):  # Blender would copy them one by one
        return np.arange(len(mesh.loops), dtype=np.int32).reshape(-1, 3)
    mesh.calc_loop_triangles()
    return read_property(mesh.loop_triangles, "loops", np.int32, 3)


def has_sound_triangles(mesh: bpy.types.Mesh) -> bool:
    """Whether a mesh is triangles of three vertices, no two of the same; False for too many to tell."""
    if not _is_triangulated(mesh) or len(mesh.vertices) >> 21:
        return False
    # Three numbers of 21 bits in one
    low, middle, high = np.sort(corner_vertices(mesh).reshape(-1, 3), axis=1).T.astype(np.int64)
    triangles = np.sort(low << 42 | middle << 21 | high)
    return bool(np.all(low < middle) and np.all(middle < high) and np.all(triangles[:-1] < triangles[1:]))


def vertex_positions(mesh: bpy.types.Mesh) -> Array:
    """Shape (V, 3)."""
    return read_property(mesh.vertices, "co", np.float32, 3)


def corner_vertices(mesh: bpy.types.Mesh) -> Indices:
    """Vertex of each corner, shape (corners, 1); Blender copies attributes faster than the property."""
    attribute = mesh.attributes.get(".corner_vert")
    return read_property(attribute.data, "value", np.int32) if attribute else np.empty((0, 1), np.int32)


def drawn_normals(mesh: bpy.types.Mesh) -> Array:
    """Normals of each vertex where corners agree, of each corner otherwise."""
    of_vertices = mesh.normals_domain == "POINT"
    return read_property(mesh.vertex_normals if of_vertices else mesh.corner_normals, "vector", np.float32, 3)


def read_property(items: Any, field: str, kind: type[T], width: int = 1) -> NDArray[T]:
    """A property of every item, shape (len(items), width), without a Python loop."""
    values = np.empty(len(items) * width, dtype=kind)
    items.foreach_get(field, values)
    return values.reshape(-1, width)


def _is_triangulated(mesh: bpy.types.Mesh) -> bool:
    return len(mesh.loops) == 3 * len(mesh.polygons)
