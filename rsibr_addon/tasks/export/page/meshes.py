"""Meshes as a page unpacks them: mesh.js has the way back.

Coordinates and normals are what they differ by from a guess, which is close on smooth surfaces.
"""

from typing import Any

import numpy as np

from ....core.conventions import Array, Indices
from ....core.errors import RangeError
from ....core.maps.octahedral import uv_from_direction
from ....files.packed_arrays import packed_integers
from ....host.meshes import TriangleMesh

MOST_TRIANGLES = 1_000_000
"""Of a mesh: some 8 MB."""

STEPS = 32767
"""Of a coordinate, from 0 to 1."""

NORMAL_STEPS = 8191
"""Of a place on the octahedral map of normals, from its middle to its edge."""

PLACES = 9
"""Of normals that are made, in decimals."""


def in_order_of_use(triangles: Indices) -> tuple[Indices, Indices]:
    """Vertices in the order in which triangles come to them.

    Parameters
    ----------
    triangles : ndarray of int, shape (T, 3)

    Returns
    -------
    order : ndarray of int, shape (V,)
        The vertices that are used.
    triangles : ndarray of int, shape (T, 3)
        By place in this order.
    """
    used, first, numbers = np.unique(triangles, return_index=True, return_inverse=True)
    by_use = np.argsort(first)
    places = np.empty_like(by_use)
    places[by_use] = np.arange(len(by_use))
    return used[by_use], places[numbers].reshape(-1, 3)


def packed_mesh(mesh: TriangleMesh) -> dict[str, Any]:
    """A mesh within the unit sphere.

    Parameters
    ----------
    mesh : TriangleMesh
        Its vertices are in the order of `in_order_of_use`.

    Returns
    -------
    dict
        "triangles", a row for each corner; "positions", a row for each coordinate in `STEPS`, less the guess
        of `_guesses`; and "normals", a row for each coordinate of `_normal_codes`, less that of the normals
        that the positions make. Where normals are the positions, as of a sphere, they are None.

    Raises
    ------
    RangeError
        It has too many triangles.
    """
    if len(mesh.triangles) > MOST_TRIANGLES:
        raise RangeError(
            f"{mesh.name} has {len(mesh.triangles):,} triangles, and a page takes {MOST_TRIANGLES:,} at "
            f"most: decimate it."
        )
    positions = np.rint(STEPS * mesh.positions.astype(np.float64)).astype(np.int32)
    a, b, opposite = _guesses(mesh.triangles, len(positions)).T
    known = np.concatenate([positions, np.zeros((1, 3), np.int32)])  # the last for what has no guess
    packed = {
        "positions": packed_integers((positions - known[a] - known[b] + known[opposite]).T, 16, along=()),
        "normals": None,
        "triangles": packed_integers(mesh.triangles.T, 32, along=(1,)),
    }
    if not np.array_equal(mesh.positions, mesh.normals):
        guessed = _normal_codes(made_normals(positions, mesh.triangles))
        packed["normals"] = packed_integers((_normal_codes(mesh.normals) - guessed).T, 16, along=())
    return packed


def _guesses(triangles: Indices, count: int) -> Indices:
    """What each vertex is guessed from, before its triangle is there.

    Returns
    -------
    ndarray of int, shape (count, 3)
        a, b and o of the guess a + b - o: across the edge of a and b from the corner o of an earlier
        triangle, in a parallelogram. Where there is none, b is o, and a is another corner, or the vertex
        before; -1 for the first vertex.
    """
    guesses = np.zeros((count, 3), np.int64)
    across: dict[tuple[int, int], int] = {}
    known = 0
    for corners in triangles.tolist():
        for corner in range(3):
            if corners[corner] != known:
                continue
            a, b = corners[corner - 2], corners[corner - 1]
            opposite = across.get((min(a, b), max(a, b)), -1)
            if opposite >= 0:
                guesses[known] = a, b, opposite
            else:
                guesses[known, 0] = next((each for each in (a, b) if each < known), known - 1)
            known += 1
        for corner in range(3):
            a, b = corners[corner - 2], corners[corner - 1]
            across[min(a, b), max(a, b)] = corners[corner]
    return guesses


def made_normals(positions: Indices, triangles: Indices) -> Array:
    """Normals of vertices: those of their triangles, weighted by the angles there, as Blender makes them.

    Parameters
    ----------
    positions : ndarray of int, shape (V, 3)
        In steps.
    triangles : ndarray of int, shape (T, 3)

    Returns
    -------
    ndarray, shape (V, 3)
        Unit vectors; 0 where triangles have no area. Rounded to `PLACES`, so that a browser, whose last
        digits differ, is on the same side of the map's folds, on which symmetric meshes lie.
    """
    corners = positions[triangles].astype(np.float64)
    area = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.linalg.norm(area, axis=1)
    facets = area / np.maximum(size, 1.0)[:, None]
    normals = np.zeros((len(positions), 3))
    for corner in range(3):
        here = corners[:, corner]
        along, other = corners[:, corner - 2] - here, corners[:, corner - 1] - here
        angle = np.arctan2(size, np.sum(along * other, axis=1))
        np.add.at(normals, triangles[:, corner], angle[:, None] * facets)
    rounded: Array = np.round(normals / np.maximum(np.linalg.norm(normals, axis=1), 1e-9)[:, None], PLACES)
    return rounded


def _normal_codes(normals: Array) -> Indices:
    """Places on the octahedral map in steps, shape (V, 2); the middle's where a normal is 0."""
    given = np.where(np.any(normals, axis=1, keepdims=True), normals, [0.0, 0.0, 1.0])
    codes: Indices = np.rint(NORMAL_STEPS * (2.0 * uv_from_direction(given) - 1.0)).astype(np.int32)
    return codes
