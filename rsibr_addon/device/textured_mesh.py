"""Meshes with UV maps, tangents and material slots on the GPU."""

import gpu
import numpy as np

from ..core.conventions import Array, Indices
from . import buffers
from .drawing import Draw, GpuMesh
from .own_materials import MOST_UV_MAPS

ATTRIBUTES = {"position": 3, "normal": 3, "tangent": 4, "uv_a": 4, "uv_b": 4}
"""Name of each vertex attribute -> its numbers; `uv_a` holds the first two UV maps, `uv_b` the others."""


class GpuTexturedMesh(GpuMesh):
    """An uploaded mesh that is drawn whole, as any other, or slot by slot.

    Parameters
    ----------
    positions, normals : ndarray, shape (V, 3)
    triangles : ndarray of int, shape (F, 3)
    slots : ndarray of int, shape (F,)
        Material slot of each triangle.
    uv : ndarray, shape (V, U, 2)
        `MOST_UV_MAPS` at most; what is not given takes no memory.
    tangents : ndarray, shape (V, 4), optional
        Unit vectors in the object's space, and the bitangent's sign, as normal maps need them.
    uv_maps : tuple of str
        Their names; the first is the one that the mesh renders with.
    """

    def __init__(
        self,
        positions: Array,
        normals: Array,
        triangles: Indices,
        slots: Indices,
        uv: Array,
        tangents: Array | None = None,
        uv_maps: tuple[str, ...] = (),
    ) -> None:
        self._ends, by_slot = slot_ends(slots)
        attributes = {"position": positions, "normal": normals, **uv_attributes(uv)}
        if tangents is not None:
            attributes["tangent"] = tangents
        self._batch = _batch(attributes, triangles[by_slot])
        self._placed = buffers.KeptBlock()
        self.uv_maps = uv_maps

    def draw_slot(self, shader: gpu.types.GPUShader, draw: Draw, slot: int, last: bool = False) -> None:
        """Draw the triangles of one slot into the active frame buffer; see `draw`.

        Parameters
        ----------
        shader : GPUShader
        draw : Draw
        slot : int
        last : bool
            Whether triangles of all slots beyond are drawn, too.
        """
        ends = [0, *self._ends]
        begin, end = ends[min(slot, len(ends) - 1)], ends[-1 if last else min(slot + 1, len(ends) - 1)]
        if end > begin:
            self.place(shader, draw)
            self._batch.draw_range(shader, elem_start=3 * begin, elem_count=3 * (end - begin))


def slot_ends(slots: Indices) -> tuple[list[int], Indices]:
    """How many triangles the slots up to each have, and the order of triangles by slot.

    Parameters
    ----------
    slots : ndarray of int, shape (F,)
        Of each triangle.

    Returns
    -------
    ends : list of int
    order : ndarray of int, shape (F,)
    """
    return np.cumsum(np.bincount(slots)).tolist(), np.argsort(slots, kind="stable")


def uv_attributes(uv: Array) -> dict[str, Array]:
    """UV maps as vertex attributes, see `ATTRIBUTES`; those without any are left out.

    Parameters
    ----------
    uv : ndarray, shape (V, maps, 2)

    Returns
    -------
    dict of str to ndarray, shape (V, 4)
    """
    pairs = uv.reshape(len(uv), -1)[:, : 2 * MOST_UV_MAPS]
    named = ((0, "uv_a"), (4, "uv_b"))
    return {name: _widened(pairs[:, first : first + 4]) for first, name in named if pairs.shape[1] > first}


def _widened(values: Array) -> Array:
    """Columns filled up to four with 0."""
    filled: Array = np.zeros((len(values), 4), np.float32)
    filled[:, : values.shape[1]] = values
    return filled


def _batch(attributes: dict[str, Array], triangles: Indices) -> gpu.types.GPUBatch:
    """Triangles with just these attributes, for any program that has some of them."""
    layout = gpu.types.GPUVertFormat()
    for name in attributes:
        layout.attr_add(id=name, comp_type="F32", len=ATTRIBUTES[name], fetch_mode="FLOAT")
    vertices = gpu.types.GPUVertBuf(layout, len(attributes["position"]))
    for name, values in attributes.items():
        vertices.attr_fill(name, np.ascontiguousarray(values, np.float32))
    indices = gpu.types.GPUIndexBuf(type="TRIS", seq=np.ascontiguousarray(triangles, np.int32))
    return gpu.types.GPUBatch(type="TRIS", buf=vertices, elem=indices)
