"""Meshes with what textures need: UV maps, the tangents of normal maps, and the slot of each triangle."""

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import bpy
import numpy as np

from ..core.conventions import Array, Indices
from ..core.geometry.tangents import tangents
from .mesh_arrays import (
    bits,
    corner_uv,
    corner_vertices,
    drawn_normals,
    numbered,
    split_vertices,
    triangle_corners,
    triangle_slots,
    uv_map_named,
    vertex_positions,
)
from .meshes import TriangleMesh, content_of


@dataclass(frozen=True)
class MeshNeeds:
    """What an object's materials need of its mesh.

    Attributes
    ----------
    uv_maps : tuple of str
        UV maps that textures lie on; an empty name is the one that the mesh renders with.
    tangents : tuple of str or None
        By slot, the UV map of the normal maps' tangents; None where a slot's material needs none.
        What lies beyond has the last one's.
    """

    uv_maps: tuple[str, ...]
    tangents: tuple[str | None, ...]

    @property
    def tangent_maps(self) -> list[str]:
        """The UV maps of tangents, each once."""
        return list(dict.fromkeys(each for each in self.tangents if each is not None))


@dataclass(frozen=True)
class TexturedMesh(TriangleMesh):
    """Triangles to be textured. Vertices are split only where corners disagree.

    Attributes
    ----------
    uv_maps : tuple of str
        Names of those of `MeshNeeds` that it has, each once; the one that it renders with, if that is needed,
        comes first.
    uv : ndarray, shape (V, len(uv_maps), 2), float32
    tangents : ndarray, shape (V, 4), float32, optional
        See `core.geometry.tangents`; 0 where a slot needs none, or the mesh does not have the UV map. None
        where no slot needs any.
    slots : ndarray, shape (T,), int32
        The material slot of each triangle, from 0; it may lie beyond the last one.
    """

    uv_maps: tuple[str, ...]
    uv: Array
    tangents: Array | None
    slots: Indices


def textured_mesh(mesh: bpy.types.Mesh, name: str, needs: MeshNeeds) -> TexturedMesh:
    """A mesh's surface, with what its materials need.

    Parameters
    ----------
    mesh : bpy.types.Mesh
        As `meshes.evaluated_mesh` yields it.
    name : str
    needs : MeshNeeds

    Returns
    -------
    TexturedMesh
    """
    surface = _Corners(mesh)
    maps = _uv_maps(mesh, needs.uv_maps)
    uv = np.empty((len(surface.corners), len(maps), 2), np.float32)
    for number, at_corners in enumerate(maps.values()):
        uv[:, number] = at_corners[surface.corners]
    tangent, groups = _tangents(mesh, needs, surface)
    keys = np.vstack([surface.keys, bits(uv.reshape(len(uv), -1)), groups])
    kept, split = split_vertices(surface.count, surface.vertices, keys)
    return TexturedMesh(
        name,
        surface.positions[kept],
        surface.normals[kept],
        split.reshape(-1, 3),
        tuple(maps),
        uv[kept],
        tangent[kept] if needs.tangent_maps else None,
        surface.slots,
    )


def textured_content_of(mesh: bpy.types.Mesh, needs: MeshNeeds) -> bytes:
    """A hash of all data that `textured_mesh` depends on, in a fraction of its time."""
    content = hashlib.sha1(content_of(mesh) + repr(needs).encode(), usedforsecurity=False)
    content.update(triangle_slots(mesh).data)
    for name, at_corners in _uv_maps(mesh, [*needs.uv_maps, *needs.tangent_maps]).items():
        content.update(name.encode())
        content.update(at_corners.data)
    return content.digest()


class _Corners:
    """Corners of triangles, shape (3 T, ...): two triangles of a face may disagree where they share one.

    Attributes
    ----------
    corners : ndarray
        Corner of the mesh.
    vertices, places : ndarray of int32
        Vertex of the mesh; and the first of those that have the same position, and normal where vertices do.
    count : int
        Vertices of the mesh.
    positions, normals : ndarray, float32
    keys : ndarray of int32
        Bits of the normal where a vertex may have several, by row; no row otherwise.
    slots : ndarray of int32, shape (T,)
    """

    def __init__(self, mesh: bpy.types.Mesh) -> None:
        positions, normals = vertex_positions(mesh), drawn_normals(mesh)
        self.corners = triangle_corners(mesh).ravel()
        self.vertices = corner_vertices(mesh)[self.corners, 0]
        self.count = len(positions)
        self.positions = positions[self.vertices]
        of_vertices = mesh.normals_domain == "POINT"
        self.normals = normals[self.vertices if of_vertices else self.corners]
        self.keys = bits(self.normals[:, :0] if of_vertices else self.normals)
        self._rows = np.hstack([positions, normals]) if of_vertices else positions
        self.slots = triangle_slots(mesh)

    @cached_property
    def places(self) -> Indices:
        """See the class."""
        numbers: Indices = numbered(self._rows)[self.vertices]
        return numbers


def _uv_maps(mesh: bpy.types.Mesh, names: Sequence[str]) -> dict[str, Array]:
    """Name -> places, of the UV maps that a mesh has of these, the one that it renders with by "" first."""
    found = {}
    for name in sorted(names):
        uv_map, at_corners = uv_map_named(mesh, name), corner_uv(mesh, name)
        if at_corners is not None:
            found[uv_map.name] = at_corners
    return found


def _tangents(mesh: bpy.types.Mesh, needs: MeshNeeds, surface: _Corners) -> tuple[Array, Indices]:
    """Tangents at corners, each of the UV map that its slot needs, and numbers of those that are shared.

    Returns
    -------
    tangents : ndarray, shape (3 T, 4), float32
    groups : ndarray of int32, shape (3 T,)
    """
    count = len(surface.corners)
    found, groups = np.zeros((count, 4), np.float32), np.zeros(count, np.int32)
    of_slots = np.repeat(np.clip(surface.slots, 0, len(needs.tangents) - 1), 3)
    for name in needs.tangent_maps:
        uv = corner_uv(mesh, name)
        if uv is None:
            continue
        map_place = uv[surface.corners]
        keys = np.vstack([surface.keys, bits(map_place)])
        _, welded = split_vertices(surface.count, surface.places, keys)
        of_map, groups_of_map = tangents(
            surface.positions.reshape(-1, 3, 3),
            surface.normals.reshape(-1, 3, 3),
            map_place.reshape(-1, 3, 2),
            surface.places.reshape(-1, 3),
            welded.reshape(-1, 3),
        )
        is_here = np.array([each == name for each in needs.tangents])[of_slots]
        found[is_here] = of_map.reshape(-1, 4)[is_here]
        groups[is_here] = groups_of_map.ravel()[is_here] + groups.max() + np.int32(1)
    return found, groups
