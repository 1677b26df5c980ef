"""Normals that images give a surface, as Cycles has them: normal maps and bumps."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..conventions import Array, ArrayLike
from ..errors import ShapeError
from ..geometry.directions import dot, normalize
from .principled import Baked, Bump, Normal, NormalMap, Texture
from .surfaces import value_at

_STEP = 0.1
"""Share of a pixel after which Cycles looks a height up again: its default filter width."""


@dataclass(frozen=True)
class SurfacePoints:
    """Points of a mesh, each in the middle of a pixel; N of them, in the object's own space.

    Attributes
    ----------
    normal : ndarray, shape (N, 3)
        Interpolated between vertices; of any length above 0.
    tangent : ndarray, shape (N, 4)
        Tangent of the normal map's UV map, and the sign of the bitangent.
    uv : mapping of str to ndarray, shape (N, 2)
        UV maps, that which the mesh renders with under the empty name.
    position_steps : ndarray, shape (2, N, 3)
        From a pixel to the next on the right, and to the next above.
    uv_steps : mapping of str to ndarray, shape (2, N, 2)
        The same of UV maps.
    """

    normal: Array
    tangent: Array
    uv: Mapping[str, Array]
    position_steps: Array
    uv_steps: Mapping[str, Array]


def shading_normal(normal: Normal, texels: Mapping[Texture, Array], points: SurfacePoints) -> Array:
    """Normals that a material is shaded with.

    Parameters
    ----------
    normal : NormalMap, Bump or None
    texels : mapping of Texture to ndarray, shape (height, width, 4)
    points : SurfacePoints

    Returns
    -------
    ndarray, shape (N, 3)
        Unit vectors.

    Raises
    ------
    ShapeError
        The normal, or an input of it, is still to be baked.
    """
    if isinstance(normal, Baked):
        raise ShapeError(f"The material's normal is still to be baked ({normal.reason}): bake it first.")
    if isinstance(normal, NormalMap):
        color, strength = (value_at(each, texels, points.uv) for each in (normal.color, normal.strength))
        return mapped_normal(color, strength, points.normal, points.tangent)
    if isinstance(normal, Bump):
        below = shading_normal(normal.normal, texels, points)
        strength, distance = (
            value_at(each, texels, points.uv) for each in (normal.strength, normal.distance)
        )
        height = value_at(normal.height, texels, points.uv)
        moved = (
            {name: uv + _STEP * points.uv_steps[name][side] for name, uv in points.uv.items()}
            for side in (0, 1)
        )
        rises = [(value_at(normal.height, texels, uv) - height) / _STEP for uv in moved]
        distance = -distance if normal.invert else distance
        return bumped_normal(below, points.position_steps, distance * np.stack(rises), strength)
    return normalize(points.normal)


def mapped_normal(color: ArrayLike, strength: ArrayLike, normal: ArrayLike, tangent: ArrayLike) -> Array:
    """Normals of a normal map in tangent space.

    Parameters
    ----------
    color : array_like, shape (..., 3)
        Encodes a normal as 0.5 + 0.5 n.
    strength : array_like, shape (..., 1)
        Leans the normal further than the map; it is upright for 0.
    normal : array_like, shape (..., 3)
        Interpolated, not normalised.
    tangent : array_like, shape (..., 4)
        Of mikktspace, and the sign of the bitangent; 0 where there is none.

    Returns
    -------
    ndarray, shape (..., 3)
        Unit vectors; where the map makes none, the normal itself.

    Notes
    -----
    GLSL twin: gpu_shaders/lib/shading_normal_lib.glsl `mapped_normal`.
    """
    strength, normal, tangent = np.asarray(strength), np.asarray(normal), np.asarray(tangent)
    encoded = 2.0 * np.asarray(color) - 1.0
    upright = 1.0 + np.clip(strength, 0.0, 1.0) * (encoded[..., 2:] - 1.0)
    bitangent = tangent[..., 3:] * np.cross(normal, tangent[..., :3])
    leaning = encoded[..., :1] * tangent[..., :3] + encoded[..., 1:2] * bitangent
    return _unit_or(strength * leaning + upright * normal, normal)


def bumped_normal(
    normal: ArrayLike, position_steps: ArrayLike, rises: ArrayLike, strength: ArrayLike
) -> Array:
    """Normals of a surface that is raised along its normals.

    Parameters
    ----------
    normal : array_like, shape (..., 3)
        Unit vectors.
    position_steps : array_like, shape (2, ..., 3)
        Two steps along the surface.
    rises : array_like, shape (2, ..., 1)
        How much higher the surface is after each, in the same unit.
    strength : array_like, shape (..., 1)
        Share of the raised surface's normal, from 0; beyond 1 it leans further.

    Returns
    -------
    ndarray, shape (..., 3)
        Unit vectors.

    Notes
    -----
    [Mikkelsen2010]. GLSL twin: gpu_shaders/lib/shading_normal_lib.glsl `bumped_normal`.
    """
    normal, strength = np.asarray(normal, np.float64), np.maximum(strength, 0.0)
    (right, above), (to_right, to_above) = np.asarray(position_steps), np.asarray(rises)
    across_above, across_right = np.cross(above, normal), np.cross(normal, right)
    area = dot(right, across_above)[..., None]
    slope = to_right * across_above + to_above * across_right
    raised = _unit_or(np.abs(area) * normal - np.sign(area) * slope, normal)
    return _unit_or(strength * raised + (1.0 - strength) * normal, normal)


def _unit_or(vector: Array, other: Array) -> Array:
    """Vectors made unit vectors, those of no length by the other ones."""
    length = np.linalg.norm(vector, axis=-1, keepdims=True)
    return normalize(np.where(length > 0.0, vector, other))
