"""The sphere map: an orthographic picture of a sphere, as in [Cabral1999] section 3.3.

A point (s, t) of the map is a point of the sphere's visible half, hence a normal; by mirror
reflection of the one view direction it is also a direction of the whole sphere. Both readings are
here, in the camera's own coordinates: x right, y up, z towards the camera. The map fills the
square; texels outside the inscribed disk belong to no normal.
"""

import numpy as np

from ..conventions import Array, ArrayLike, Indices, texel_centres
from ..errors import ShapeError


def normal_from_uv(uv: ArrayLike) -> Array:
    """g_normal: the normal seen at a point of the map.

    Parameters
    ----------
    uv : array_like, shape (..., 2)
        Map coordinates (s, t). Points outside the disk are taken at the nearest point of its rim.

    Returns
    -------
    ndarray, shape (..., 3), float64
        Unit normals with z >= 0.

    Notes
    -----
    [Cabral1999] section 3.3; the printed root has a plus for the second minus, which would not
    give a unit vector. GLSL twin: gpu_shaders/lib/sphere_map_lib.glsl `normal_from_uv`, 1e-6 in x and
    y; z is the root of a difference known to 6 * 2**-24, hence 4e-7 / z, and 6e-4 at the rim.
    """
    xy = 2.0 * np.asarray(uv, dtype=np.float64) - 1.0
    radius = np.linalg.norm(xy, axis=-1, keepdims=True)
    xy = xy / np.maximum(radius, 1.0)
    z = np.sqrt(np.maximum(1.0 - np.sum(xy * xy, axis=-1, keepdims=True), 0.0))
    return np.concatenate([xy, z], axis=-1)


def uv_from_normal(normal: ArrayLike) -> Array:
    """The inverse of `normal_from_uv`; normals that face away are mapped to the rim.

    Parameters
    ----------
    normal : array_like, shape (..., 3)
        Unit normals in camera coordinates; (0, 0, -1) is mapped to the rim's rightmost point.

    Returns
    -------
    ndarray, shape (..., 2), float64
        (s, t) in the disk.

    Notes
    -----
    [Cabral1999] section 3.3. GLSL twin: gpu_shaders/lib/sphere_map_lib.glsl `uv_from_normal`, 1e-6.
    """
    normal = np.asarray(normal, dtype=np.float64)
    xy = normal[..., :2]
    radius = np.linalg.norm(xy, axis=-1, keepdims=True)
    on_rim = np.where(radius > 0.0, xy / np.where(radius > 0.0, radius, 1.0), (1.0, 0.0))
    return 0.5 * np.where(normal[..., 2:] < 0.0, on_rim, xy) + 0.5


def direction_from_uv(uv: ArrayLike) -> Array:
    """g_mirror: the direction that a mirrored sphere shows at a point of the map.

    Points outside the disk as in `normal_from_uv`; the whole rim shows (0, 0, -1), the singularity.

    Notes
    -----
    [Cabral1999] section 3.3. GLSL twin: gpu_shaders/lib/sphere_map_lib.glsl `direction_from_uv`, 2e-6
    in z; twice the error of the normal's z in x and y, hence 7e-7 / normal.z, and 1.2e-3 at the rim.
    """
    normal = normal_from_uv(uv)
    z = normal[..., 2:]
    return np.concatenate([2.0 * z * normal[..., :2], 2.0 * z * z - 1.0], axis=-1)


def uv_from_direction(direction: ArrayLike) -> Array:
    """The inverse of `direction_from_uv`; (0, 0, -1) is mapped to the rim's rightmost point.

    Notes
    -----
    [Cabral1999] section 3.3: the half vector of direction and camera is the normal (the printed denominator
    lacks its square root). GLSL twin: gpu_shaders/lib/sphere_map_lib.glsl `uv_from_direction`, 1e-6, except
    for directions within 1e-6 of (0, 0, -1), which count as this direction.
    """
    direction = np.asarray(direction, dtype=np.float64)
    half = direction + (0.0, 0.0, 1.0)
    length = np.linalg.norm(half, axis=-1, keepdims=True)
    singular = length < 1e-12
    normal = np.where(singular, (1.0, 0.0, 0.0), half / np.where(singular, 1.0, length))
    return uv_from_normal(normal)


def texel_angle(size: int) -> float:
    """Distance between texels in reflected directions [rad], of a map of size x size texels.

    Notes ----- The square root of a texel's solid angle: a mirrored sphere shows equal solid angles in equal
    areas, 4 pi in pi times a radius of size / 2. GLSL twin: gpu_shaders/lib/sphere_map_lib.glsl
    `sphere_map_texel_angle`.
    """
    return 4.0 / size


def texel_solid_angle(size: int) -> Array:
    """Solid angle of each texel's reflected directions [sr], shape (size, size): exact, sums to 4 pi.

    A mirrored sphere shows equal solid angles in equal areas, d omega = 4 cos d omega_normal = 4 dA, so this
    is four times the area of a texel within the disk.
    """
    # A texel of a map twice as fine never straddles an axis, so one quadrant gives all.
    edges = np.linspace(0.0, 1.0, size + 1)
    x0, x1 = edges[None, :-1], edges[None, 1:]
    y0, y1 = edges[:-1, None], edges[1:, None]

    def under_circle(x: Array) -> Array:
        area: Array = 0.5 * (x * np.sqrt(1.0 - x * x) + np.arcsin(x))
        return area

    above_top = np.clip(np.sqrt(1.0 - y1 * y1), x0, x1)
    above_bottom = np.clip(np.sqrt(1.0 - y0 * y0), x0, x1)
    area = (above_top - x0) * (y1 - y0)
    area = area + under_circle(above_bottom) - under_circle(above_top) - y0 * (above_bottom - above_top)
    half = np.concatenate([area[:, ::-1], area], axis=1)
    disk = np.concatenate([half[::-1], half], axis=0)
    quarters = disk.reshape(size, 2, size, 2)
    return 4.0 * quarters.sum(axis=(1, 3))


def wrap(columns: Indices, rows: Indices, width: int, height: int) -> tuple[Indices, Indices]:
    """Texel that a lookup beyond the map's edge falls on: the edge's own."""
    return np.clip(columns, 0, width - 1), np.clip(rows, 0, height - 1)


def fill_rim(radiance: Array, coverage: Array) -> Array:
    """Make a rendered sphere into a map that can be looked up everywhere.

    Texels that the disk only partly covers get the mean radiance of the covered part. Texels outside take
    the value at the rim on the way to the centre, so that bilinear lookups near the rim mix in nothing
    foreign.

    Parameters
    ----------
    radiance : ndarray, shape (size, size, 3)
        Radiance times coverage, as a renderer leaves it.
    coverage : ndarray, shape (size, size)
        Covered part of each texel, in [0, 1].

    Returns
    -------
    ndarray, shape (size, size, 3), float32

    Raises
    ------
    ShapeError
        The map is not square, or too small to hold a fully covered texel.
    """
    height, width = coverage.shape
    if height != width or not np.any(coverage > 0.5):
        raise ShapeError(f"A sphere map is square and shows a sphere; this one is {width}x{height}.")
    # A sliver's colour is mostly noise: texels less than half covered count as outside.
    inside = coverage > 0.5
    filled = radiance / np.where(inside, coverage, 1.0)[..., None]
    centred = texel_centres(width, height) * 2.0 - 1.0
    radius = np.linalg.norm(centred, axis=-1)
    outside = ~inside
    direction = centred[outside] / radius[outside][:, None]
    # Step inwards until the nearest texel is one of the disk's.
    texel = 2.0 / width
    rows = np.zeros(direction.shape[0], dtype=np.intp)
    columns = np.zeros_like(rows)
    pending = np.ones(direction.shape[0], dtype=bool)
    for step in range(width):
        point = (1.0 - 0.5 * step * texel) * direction
        column, row = (np.floor((point + 1.0) / texel).astype(np.intp)).clip(0, width - 1).T
        found = pending & inside[row, column]
        rows[found], columns[found] = row[found], column[found]
        pending &= ~found
        if not pending.any():
            break
    filled[outside] = filled[rows, columns]
    return filled.astype(np.float32)
