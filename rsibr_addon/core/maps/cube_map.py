"""The cube map: six faces in OpenGL's order and orientation, projected from the cube's centre.

Faces are +X -X +Y -Y +Z -Z. (u, v) are OpenGL's (s, t), so that row 0 of a face is the row that OpenGL
stores first: the array is the texture, and a shader's lookup by a direction finds it. Seen as a
picture, a face is therefore upside down; files turn it over (docs/conventions.md).
"""

import numpy as np

from ..conventions import Array, ArrayLike, Indices, texel_centres

SHEETS = ("px", "nx", "py", "ny", "pz", "nz")

FACES = np.array(
    [
        [[0, 0, -1], [0, -1, 0], [1, 0, 0]],
        [[0, 0, 1], [0, -1, 0], [-1, 0, 0]],
        [[1, 0, 0], [0, 0, 1], [0, 1, 0]],
        [[1, 0, 0], [0, 0, -1], [0, -1, 0]],
        [[1, 0, 0], [0, -1, 0], [0, 0, 1]],
        [[-1, 0, 0], [0, -1, 0], [0, 0, -1]],
    ]
)
"""Directions of growing s, of growing t and of the face itself: OpenGL 4.6, table 8.19."""

NOWHERE = -1
"""The sheet of a texel that does not exist: at the cube's corners three texels meet, not four."""


def direction_from_uv(uv: ArrayLike, sheet: Indices) -> Array:
    """The direction that a point of a face, 0 to 5, shows: see `core.maps`."""
    s, t = np.moveaxis(2.0 * np.asarray(uv, dtype=np.float64) - 1.0, -1, 0)
    direction = np.empty((3, *np.broadcast_shapes(s.shape, np.shape(sheet))))
    for component, of_faces in enumerate(FACES.T):
        along_s, along_t, towards = of_faces[:, sheet]
        direction[component] = s * along_s + t * along_t + towards
    direction /= np.sqrt(1.0 + s * s + t * t)
    return np.moveaxis(direction, 0, -1)


def uv_from_direction(direction: ArrayLike) -> tuple[Array, Indices]:
    """The inverse of `direction_from_uv`, of directions of any positive length.

    A direction on an edge belongs to the face that comes first along the axes.
    """
    x, y, z = np.moveaxis(np.asarray(direction, dtype=np.float64), -1, 0)
    far_x, far_y, far_z = np.abs(x), np.abs(y), np.abs(z)
    along_x = far_x >= np.maximum(far_y, far_z)
    along_y = ~along_x & (far_y >= far_z)
    major = np.where(along_x, x, np.where(along_y, y, z))
    sign = np.copysign(1.0, major)
    sign_z = sign * z
    uv = np.empty((2, *major.shape))
    uv[0] = np.where(along_x, -sign_z, np.where(along_y, x, sign * x))
    uv[1] = np.where(along_y, sign_z, -y)
    uv *= 0.5 / np.abs(major)
    uv += 0.5
    return np.moveaxis(uv, 0, -1), np.where(along_x, 0, np.where(along_y, 2, 4)) + (major < 0.0)


def texel_solid_angle(size: int) -> Array:
    """Solid angle of every texel [sr], shape (6, size, size): exact, sums to 4 pi.

    The solid angle of the rectangle from the face's centre to (s, t) is atan(s t / sqrt(1 + s^2 + t^2)).
    """
    s = np.linspace(-1.0, 1.0, size + 1)
    t = s[:, None]
    corner = np.arctan2(s * t, np.sqrt(1.0 + s * s + t * t))
    face = np.diff(np.diff(corner, axis=0), axis=1)
    return np.repeat(face[None], 6, axis=0)


def texel_angle(direction: ArrayLike, size: int) -> Array:
    """Distance between texels around a direction.

    Parameters
    ----------
    direction : array_like, shape (..., 3)
        Unit directions.
    size : int
        Width and height of a face in texels.

    Returns
    -------
    ndarray, shape (...,)
        [rad], the square root of a texel's solid angle. A texel is 2 / size wide on a face at distance 1. The
        direction meets the face farther away and aslant, which leaves m^3 of that area, m being the
        direction's largest component.

    Notes
    -----
    GLSL twin: gpu_shaders/lib/cube_map_lib.glsl `cube_texel_angle`, 1e-6 of it.
    """
    major = np.max(np.abs(direction), axis=-1)
    angle: Array = 2.0 / size * major**1.5
    return angle


def turned(faces: Array, rotation: Array) -> Array:
    """The same cube in other axes, texel for texel.

    Parameters
    ----------
    faces : ndarray, shape (6, size, size, channels)
    rotation : ndarray, shape (3, 3)
        New directions from old ones; takes axes to axes, so that texels' centres meet.

    Returns
    -------
    ndarray, shape (6, size, size, channels)
    """
    size = faces.shape[1]
    uv = texel_centres(size, size)
    made = np.empty_like(faces)
    for face in range(len(FACES)):
        found, sheet = uv_from_direction(direction_from_uv(uv, np.array(face)) @ rotation)
        columns, rows = np.moveaxis(np.floor(found * size).astype(np.intp), -1, 0)
        made[face] = faces[sheet, rows, columns]
    return made


def wrap(
    columns: Indices, rows: Indices, sheet: Indices, width: int, height: int
) -> tuple[Indices, Indices, Indices]:
    """Texel that a lookup beyond a face's edge falls on: it continues on the neighbouring face.

    Beyond a corner of the cube, across two edges, there is no texel: `sheet` is `NOWHERE` there.

    Notes
    -----
    Texel centres are whole numbers on a cube with edges 2 `width`. A point of the face's plane that
    overhangs an edge is folded over it: as far down the neighbour as it overhung.
    """
    size = width
    local = np.stack([2 * columns + 1 - size, 2 * rows + 1 - size, np.full_like(columns, size)], axis=-1)
    overhang = np.maximum(np.abs(local[..., :2]) - size, 0)
    nowhere = np.all(overhang > 0, axis=-1)
    local[..., 2] -= overhang.sum(axis=-1)
    local[..., :2] = np.clip(local[..., :2], -size, size)
    point = np.einsum("...i,...ij->...j", local, FACES[sheet])
    axis = np.argmax(np.abs(point), axis=-1)
    negative = np.take_along_axis(point, axis[..., None], axis=-1)[..., 0] < 0
    folded = np.where(nowhere, sheet, 2 * axis + negative)
    on_face = np.einsum("...j,...ij->...i", point, FACES[folded])
    columns, rows = (on_face[..., 0] + size - 1) // 2, (on_face[..., 1] + size - 1) // 2
    return columns, rows, np.where(nowhere, NOWHERE, folded)
