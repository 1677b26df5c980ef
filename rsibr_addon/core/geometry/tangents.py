"""Tangents of UV maps, which normal maps refer to, as MikkTSpace [Mikkelsen2008] has them for triangles.

At a vertex, the directions of rising u are averaged over its triangles, each by its angle there, and apart
for triangles whose map is mirrored. Blender, Cycles and most programs that make normal maps do so.
"""

import numpy as np

from ..conventions import Array, Indices


def tangents(
    positions: Array, normals: Array, uv: Array, places: Indices, welded: Indices
) -> tuple[Array, Indices]:
    """The tangent of each corner of triangles.

    Parameters
    ----------
    positions : ndarray, shape (T, 3, 3), float32
        By triangle and corner.
    normals : ndarray, shape (T, 3, 3), float32
        Unit vectors.
    uv : ndarray, shape (T, 3, 2), float32
    places : ndarray of int, shape (T, 3)
        Numbers from 0, equal only for corners of equal position.
    welded : ndarray of int, shape (T, 3)
        Numbers from 0, equal for corners of equal position, normal and UV.

    Returns
    -------
    tangents : ndarray, shape (T, 3, 4), float32
        A unit vector, orthogonal to the normal but for rounding, and the factor of the cross product of
        normal and tangent that gives the bitangent: -1 where the map is mirrored. Where no triangle at a
        corner has an extent in the map, (1, 0, 0, -1).
    groups : ndarray of int, shape (T, 3)
        Equal for corners that share a tangent.
    """
    # By axis, corner and triangle, which numpy works off fast
    place, normal, map_place = (
        np.ascontiguousarray(each.transpose(2, 1, 0)) for each in (positions, normals, uv)
    )
    edges, steps = (each[:, 1:] - each[:, :1] for each in (place, map_place))
    area = steps[0, 0] * steps[1, 1] - steps[1, 0] * steps[0, 1]
    along_u = (steps[1, 1] * edges[:, 0] - steps[1, 0] * edges[:, 1]) * np.sign(area)
    sides = np.roll(place, -1, axis=1) - place
    # What has no extent says nothing, and takes the tangent of its neighbours
    is_any = (area == 0.0) | ~np.any(along_u, axis=0) | ~np.all(np.any(sides, axis=0), axis=0)
    angles = np.where(is_any, 0.0, _angles(sides, normal))
    directions = angles * _unit(_flattened(np.broadcast_to(along_u[:, None], normal.shape), normal))
    groups = _grouped(welded.T, area > 0.0, is_any, angles)
    factors = np.where(groups % 2, 1.0, -1.0)
    groups = _parted(groups, places.T, welded.T)
    count = groups.max(initial=-1) + 1
    found = np.empty((count, 4), np.float32)
    found[:, :3] = _unit(
        np.stack([np.bincount(groups.ravel(), each.ravel(), count) for each in directions])
    ).T
    found[~np.any(found[:, :3], axis=1), 0] = 1.0
    found[groups.ravel(), 3] = factors.ravel()
    return found[groups.T], groups.T


def _grouped(welded: Indices, is_upright: Array, is_any: Array, angles: Array) -> Indices:
    """Numbers of corners that may share a tangent, odd where the map is not mirrored, shape (3, T)."""
    groups: Indices = 2 * welded + is_upright.astype(welded.dtype)
    has_tangent = np.bincount(groups.ravel(), angles.ravel(), 2 * (welded.max(initial=-1) + 1)) > 0.0
    groups[:, is_any] ^= ~has_tangent[groups[:, is_any]] & has_tangent[groups[:, is_any] ^ 1]
    return groups


def _parted(groups: Indices, places: Indices, welded: Indices) -> Indices:
    """Groups parted where their triangles do not hang together by sides, shape (3, T)."""
    first = np.empty(places.max(initial=-1) + 1, groups.dtype)
    first[places] = groups
    is_seam = np.zeros(len(first), bool)
    is_seam[places[groups != first[places]]] = True
    # All corners elsewhere are one fan
    of_seam = is_seam[places] & (np.bincount(groups.ravel())[groups] > 1)
    others = [np.roll(welded, turn, axis=0)[of_seam] for turn in (-1, 1)]
    spokes = np.stack([groups[of_seam].astype(np.int64) << 32 | each for each in others])
    names, spokes = np.unique(spokes, return_inverse=True)
    fans = np.arange(spokes.shape[1])
    while True:
        lowest = np.full(len(names), len(fans))
        for each in spokes:
            np.minimum.at(lowest, each, fans)
        linked = np.minimum(*lowest[spokes])
        linked = linked[linked]  # so that long fans take few rounds
        if np.array_equal(linked, fans):
            break
        fans = linked
    parted = groups.copy()
    parted[of_seam] = groups.max(initial=-1) + 1 + fans
    return parted


def _angles(sides: Array, normal: Array) -> Array:
    """The angle of each corner within its tangent plane, shape (3, T)."""
    onwards = _unit(_flattened(sides, normal))
    backwards = _unit(_flattened(-np.roll(sides, 1, axis=1), normal))
    angles: Array = np.arccos(np.clip(_dot(onwards, backwards), -1.0, 1.0))
    return angles


def _flattened(vectors: Array, normal: Array) -> Array:
    """Vectors without what they have along normals."""
    flattened: Array = vectors - _dot(vectors, normal) * normal
    return flattened


def _unit(vectors: Array) -> Array:
    """Vectors of length 1, or 0 where they have none."""
    length = np.sqrt(_dot(vectors, vectors))
    unit: Array = vectors / np.where(length > 0.0, length, 1.0)
    return unit


def _dot(first: Array, second: Array) -> Array:
    """Scalar products over the first axis."""
    product: Array = first[0] * second[0] + first[1] * second[1] + first[2] * second[2]
    return product
