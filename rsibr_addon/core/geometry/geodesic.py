"""Evenly spread view directions: the icosahedron, its subdivisions, and weights between them.

[Cabral1999] section 3.1 takes the 12 vertices of an icosahedron; each subdivision puts a vertex on
the middle of every edge: 12, 42, 162. Section 3.4 weighs the corners of the triangle under a view.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np

from ..conventions import Array, ArrayLike, Indices
from ..errors import RangeError
from .directions import dot, normalize

VERTEX_COUNTS = (12, 42, 162)
"""Possible numbers of views: the icosahedron, once and twice subdivided."""


@dataclass(frozen=True, eq=False)
class GeodesicSphere:
    """A subdivided icosahedron, or other triangles of the sphere: see `view_sphere`.

    Attributes
    ----------
    vertices : ndarray, shape (V, 3), float64
        Unit vectors. A coarser sphere's vertices are the first of every finer one.
    levels : tuple of ndarray, shape (20 * 4**k, 3), int
        Triangles of each subdivision level, counter-clockwise seen from outside; the children of
        triangle i of one level are 4 i .. 4 i + 3 of the next: at its corners in order, and in
        its middle. The last level's triangles are the sphere's own.
    centres : ndarray, shape (F, 3)
        A vector for each triangle of the first level: a direction lies in that whose vector has the greatest
        scalar product with it. Those of the icosahedron point to its triangles' middles.
    """

    vertices: Array
    levels: tuple[Indices, ...]
    centres: Array

    @property
    def surrounds(self) -> bool:
        """Whether there are triangles between the vertices, and not each vertex alone."""
        return bool(self.triangles[0, 0] != self.triangles[0, 1])

    @property
    def triangles(self) -> Indices:
        """The finest triangles, shape (F, 3)."""
        return self.levels[-1]


def _icosahedron() -> tuple[Array, Indices]:
    golden = (1.0 + np.sqrt(5.0)) / 2.0
    corners = [(0.0, i, j * golden) for i in (-1.0, 1.0) for j in (-1.0, 1.0)]
    vertices = normalize([tuple(np.roll(corner, shift)) for shift in range(3) for corner in corners])
    nearest = np.sort(vertices @ vertices.T, axis=1)[0, -2]
    adjacent = np.isclose(vertices @ vertices.T, nearest)
    triangles = [
        (i, j, k) if np.linalg.det(vertices[[i, j, k]]) > 0.0 else (i, k, j)
        for i in range(12)
        for j in range(i + 1, 12)
        for k in range(j + 1, 12)
        if adjacent[i, j] and adjacent[j, k] and adjacent[k, i]
    ]
    return vertices, np.array(triangles)


def _subdivide(vertices: Array, triangles: Indices) -> tuple[Array, Indices]:
    middles: dict[tuple[int, int], int] = {}
    added: list[Array] = []

    def middle(i: int, j: int) -> int:
        edge = (min(i, j), max(i, j))
        if edge not in middles:
            middles[edge] = len(vertices) + len(added)
            added.append(normalize(vertices[i] + vertices[j]))
        return middles[edge]

    children: list[tuple[int, int, int]] = []
    for a, b, c in triangles.tolist():
        ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
        children += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
    return np.concatenate([vertices, added]), np.array(children)


@cache
def geodesic_sphere(vertex_count: int) -> GeodesicSphere:
    """The icosahedron, or one of its subdivisions.

    Parameters
    ----------
    vertex_count : int
        12, 42 or 162.

    Returns
    -------
    GeodesicSphere
        The same object for the same count; its arrays are read-only.

    Raises
    ------
    RangeError
        Another count.
    """
    if vertex_count not in VERTEX_COUNTS:
        counts = ", ".join(map(str, VERTEX_COUNTS))
        raise RangeError(f"There is no geodesic sphere of {vertex_count} views: choose one of {counts}.")
    vertices, triangles = _icosahedron()
    levels = [triangles]
    while len(vertices) < vertex_count:
        vertices, triangles = _subdivide(vertices, triangles)
        levels.append(triangles)
    centres = vertices[levels[0]].sum(axis=1)
    for array in (vertices, *levels, centres):
        array.setflags(write=False)
    return GeodesicSphere(vertices, tuple(levels), centres)


def find_triangle(sphere: GeodesicSphere, view_dir: ArrayLike) -> Indices:
    """The triangle under a view direction.

    Parameters
    ----------
    sphere : GeodesicSphere
    view_dir : array_like, shape (..., 3)
        Unit vectors.

    Returns
    -------
    ndarray, shape (..., 3), int
        Vertex indices of the triangle that holds each direction; on an edge, one of the two. Where no
        triangles surround the sphere, the vertex nearest to each direction, three times.

    Notes
    -----
    The triangles of an icosahedron are the Voronoi cells of their centres; below that, three
    planes through a triangle's middles tell its children apart: a descent instead of a search. Spheres of
    other views have one level.
    GLSL twin: gpu_shaders/lib/geodesic_lib.glsl `find_triangle`, equal off the edges.
    """
    view_dir = np.asarray(view_dir, dtype=np.float64)
    found = np.argmax(view_dir @ sphere.centres.T, axis=-1)
    for children in sphere.levels[1:]:
        # The middle child's corners (ab, bc, ca), counter-clockwise; its edges face the corners.
        ab, bc, ca = np.moveaxis(sphere.vertices[children[4 * found + 3]], -2, 0)
        beyond_a = dot(view_dir, np.cross(ca, ab)) < 0.0
        beyond_b = dot(view_dir, np.cross(ab, bc)) < 0.0
        beyond_c = dot(view_dir, np.cross(bc, ca)) < 0.0
        found = 4 * found + np.select([beyond_a, beyond_b, beyond_c], [0, 1, 2], default=3)
    return sphere.triangles[found]


def spherical_excess(a: ArrayLike, b: ArrayLike, c: ArrayLike) -> Array:
    """Signed area of a spherical triangle.

    Parameters
    ----------
    a, b, c : array_like, shape (..., 3)
        Unit vectors to its corners.

    Returns
    -------
    ndarray, shape (...,), float64
        [sr]; positive when the corners run counter-clockwise seen from outside.

    Notes
    -----
    [VanOosterom1983]: tan(E/2) = a.(b x c) / (1 + a.b + b.c + c.a). The same number as the sum of
    dihedral angles less pi of [Cabral1999] section 3.4, which loses half its digits in small
    triangles and does not exist in degenerate ones. GLSL twin: gpu_shaders/lib/geodesic_lib.glsl
    `spherical_excess`, 1e-6 and 3e-5 of the area: drivers approximate the arctangent.
    """
    a, b, c = np.asarray(a), np.asarray(b), np.asarray(c)
    area: Array = 2.0 * np.arctan2(dot(a, np.cross(b, c)), 1.0 + dot(a, b) + dot(b, c) + dot(c, a))
    return area


def barycentric_weights(view_dir: ArrayLike, corners: ArrayLike) -> Array:
    """Spherical barycentric weights of a direction within a triangle.

    Parameters
    ----------
    view_dir : array_like, shape (..., 3)
        Unit vectors in or on the triangle.
    corners : array_like, shape (..., 3, 3)
        Unit vectors to its corners, one a row, counter-clockwise seen from outside.

    Returns
    -------
    ndarray, shape (..., 3), float64
        In [0, 1], sum 1: the areas of the triangles opposite each corner, over their sum; equal in a triangle
        of one corner three times.

    Notes
    -----
    [Cabral1999] section 3.4. Across an edge the weights of the icosahedron are continuous; on its
    subdivisions, whose neighbours differ in shape, they jump by up to 4e-5 (42) and 1.4e-3 (162).
    GLSL twin: gpu_shaders/lib/geodesic_lib.glsl `barycentric_weights`,
    absolute tolerance 2e-5.
    """
    view_dir, corners = np.asarray(view_dir), np.asarray(corners)
    a, b, c = (corners[..., i, :] for i in range(3))
    areas = np.stack(
        [
            spherical_excess(view_dir, b, c),
            spherical_excess(view_dir, c, a),
            spherical_excess(view_dir, a, b),
        ],
        axis=-1,
    )
    areas = np.maximum(areas, 0.0)
    total = areas.sum(axis=-1, keepdims=True)
    weights: Array = np.divide(areas, total, out=np.full(areas.shape, 1.0 / 3.0), where=total > 0.0)
    return weights
