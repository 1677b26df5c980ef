"""Triangles between any view directions: [Cabral1999] section 4 loads them along with the maps.

The triangles are the facets of the directions' convex hull. A direction leaves the hull through the facet
whose plane n.x = d it meets first, that with the greatest n.v / d, so that a row of vectors n / d finds it.
"""

import numpy as np

from ..conventions import Array, ArrayLike, Indices
from ..errors import RangeError, ShapeError
from .directions import dot, normalize
from .geodesic import VERTEX_COUNTS, GeodesicSphere, geodesic_sphere

MOST_VIEWS = max(VERTEX_COUNTS)
"""Most directions of a set."""

LEAST_ANGLE = np.radians(1.0)
"""Least angle between two directions of a set [rad]."""

ROUNDED = 1e-5
"""Distance from a geodesic sphere's vertices up to which directions are taken for these: files round them."""

_LIFT = 1e-4
_GOLDEN = 0.5 * (5.0**0.5 - 1.0)
_NEAREST_FACET = 0.05


def view_sphere(view_dirs: ArrayLike) -> GeodesicSphere:
    """The triangles between some view directions.

    Parameters
    ----------
    view_dirs : array_like, shape (V, 3)
        Vectors of any length, in any order.

    Returns
    -------
    GeodesicSphere
        A subdivided icosahedron for its own vertices. Of directions that do not surround the sphere, such as
        a single one, each triangle is one direction three times: the nearest is found.

    Raises
    ------
    ShapeError
        There is no direction, or they are not of three numbers.
    RangeError
        There are more than `MOST_VIEWS`, one is 0 or not finite, or two are nearer than `LEAST_ANGLE`.
    """
    given = np.asarray(view_dirs, dtype=np.float64)
    if given.ndim != 2 or given.shape[1:] != (3,) or not len(given):
        raise ShapeError("View directions are vectors of three numbers, one or more of them.")
    if len(given) > MOST_VIEWS:
        raise RangeError(f"There are {len(given)} view directions: give {MOST_VIEWS} at most.")
    if not np.all(np.isfinite(given)) or not np.all(np.any(given, axis=1)):
        raise RangeError("A view direction is 0 or not finite: correct it.")
    # Squares of the greatest and smallest numbers are not finite, or 0
    vertices = normalize(given / np.abs(given).max(axis=1, keepdims=True))
    if len(vertices) in VERTEX_COUNTS:
        known = geodesic_sphere(len(vertices))
        if np.abs(vertices - known.vertices).max() <= ROUNDED:
            return known
    cosine = vertices @ vertices.T - 2.0 * np.eye(len(vertices))
    first, other = np.unravel_index(np.argmax(cosine), cosine.shape)
    if cosine[first, other] > np.cos(LEAST_ANGLE):
        raise RangeError(
            f"View directions {first + 1} and {other + 1} are nearer than {np.degrees(LEAST_ANGLE):g} degree "
            f"to each other: leave one of them out."
        )
    # Directions on a common circle, as of a cube, have no one hull until some are lifted a little
    lifted = vertices * (1.0 + _LIFT * (_GOLDEN * np.arange(1, len(vertices) + 1) % 1.0))[:, None]
    triangles = _hull(lifted) if _is_solid(lifted) else np.zeros((0, 3), dtype=np.intp)
    corners = lifted[triangles]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    distance = dot(across, corners[:, 0]) / np.linalg.norm(across, axis=1)
    if not len(triangles) or distance.min() < _NEAREST_FACET:
        alone = np.repeat(np.arange(len(vertices))[:, None], 3, axis=1)
        return GeodesicSphere(vertices, (alone,), vertices)
    return GeodesicSphere(vertices, (triangles,), across / dot(across, corners[:, 0])[:, None])


def _is_solid(points: Array) -> bool:
    """Whether points lie in no plane."""
    if len(points) < 4:
        return False
    return bool(np.linalg.svd(points - points.mean(axis=0), compute_uv=False)[-1] > 1e-2)


def _hull(points: Array) -> Indices:
    """Facets of the convex hull of points of which none lies within it, counter-clockwise from outside.

    Wrapped edge by edge: beyond an edge follows the point that leaves all others below.
    """
    start = int(np.argsort(-points @ points[0])[1])
    wrapped: dict[tuple[int, int], None] = {}
    found, open_edges = [], [(0, start)]
    while open_edges:
        i, j = open_edges.pop()
        if (i, j) in wrapped:
            continue
        from_first = points - points[i]
        above = (np.cross(points[j] - points[i], from_first) @ from_first.T).max(axis=1)
        above[[i, j]] = np.inf
        k = int(np.argmin(above))
        found.append((i, j, k))
        for edge in ((i, j), (j, k), (k, i)):
            wrapped[edge] = None
            open_edges.append(edge[::-1])
    return np.array(found)
