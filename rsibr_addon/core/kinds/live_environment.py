"""Light that changes with the scene: a cube map rendered around a point, filtered after every change.

[Kautz2004] section 5: six renders with a right angle of view, one for every face; their harmonics give
diffuse light, their mips glossy light.
"""

from collections.abc import Callable, Sequence
from statistics import median

import numpy as np

from ..conventions import Array, ArrayLike
from ..filtering.irradiance import real_harmonics
from ..maps import cube_map
from ..maps.representation import representation
from .mip_chain.chain import MipChain
from .mip_chain.mip_lobes import texture_space_spread
from .mip_chain.texture_space import filtered_mips

FACE_COUNT = 6

NEAREST = 5e-3
"""Near distance, relative to an object's reach, where the object is hidden: what lies within it is seen."""

FLATNESS = 1e-4
"""Depth of a flat side's vertices below the outermost, relative to an object's reach."""

LARGEST_TIP = 0.05
"""Width of the largest tip, relative to an object's reach: wider outermost parts are flat sides."""

TIP_SHOWN = 1e-5
"""Depth of a tip that is not cut off, relative to an object's reach: on a ball, a cap of 1/4 degree."""

_CUBE = representation("cube_map")


def chain_of_faces(faces: Array, halved: Callable[[Array], Array], degree: int = 2) -> MipChain:
    """The mip chain of six renders, from which an object is shaded.

    Parameters
    ----------
    faces : ndarray, shape (6, n, n, 3)
        Radiance, n a power of 2.
    halved : callable
        `mip_chain.texture_space.box_halved` or `tent_halved`.
    degree : int
        Degree of the harmonics.

    Returns
    -------
    MipChain
        Down to a single texel.

    Raises
    ------
    RangeError
        n is no power of 2, or too large.
    ShapeError
        The faces are not six squares.

    Notes
    -----
    GPU twin: `device.kinds.live_environment.GpuLiveEnvironment`.
    """
    mips = filtered_mips(faces, halved)
    return MipChain(
        tuple(mip.astype(np.float32) for mip in mips),
        harmonics_of_faces(faces, degree),
        spread=texture_space_spread(faces.shape[1], halved),
    )


def harmonics_of_faces(faces: Array, degree: int = 2) -> Array:
    """Coefficients of the radiance on a cube: the sum of radiance, solid angle and harmonic.

    Parameters
    ----------
    faces : ndarray, shape (6, n, n, channels)
    degree : int

    Returns
    -------
    ndarray, shape ((degree + 1)**2, channels), float64
        In the order of `irradiance.real_harmonics`: [Kautz2004] Eq. 11.

    Notes
    -----
    Each harmonic is taken at the texels' centres. By the cube's symmetry, constant light has nothing of
    degree 1 and 2, whatever n.
    GLSL twin: gpu_shaders/lib/live_environment_lib.glsl `harmonics_of_row` and `harmonics_of_rows`,
    1e-5 of the sum of radiance and solid angle.
    """
    size = faces.shape[1]
    weights = (
        real_harmonics(_CUBE.texel_directions(size), degree) * cube_map.texel_solid_angle(size)[..., None]
    )
    coefficients: Array = np.einsum("frck,frcn->kn", weights, np.asarray(faces, np.float64))
    return coefficients


def solid_angle_texels(size: int) -> Array:
    """Solid angles of a face's texels in every mip, as gpu_shaders/lib/live_environment_lib.glsl reads them.

    Parameters
    ----------
    size : int
        Width of the first mip, a power of 2.

    Returns
    -------
    ndarray, shape (2 * size - 1, size), float64
        [sr]; a square for each mip, from the bottom up, at the left.
    """
    texels = np.zeros((2 * size - 1, size))
    bottom = 0
    while size:
        texels[bottom : bottom + size, :size] = cube_map.texel_solid_angle(size)[0]
        bottom, size = bottom + size, size // 2
    return texels


def face_view(face: int, centre: ArrayLike) -> Array:
    """The view from a cube's centre on one of its faces.

    Parameters
    ----------
    face : int
        0 to 5, in the order of `maps.cube_map`.
    centre : array_like, shape (3,)
        In world coordinates.

    Returns
    -------
    ndarray, shape (4, 4), float64
        Camera from world coordinates: x along the face's s, y along its t, looking along -z.
    """
    s, t, forward = cube_map.FACES[face]
    view = np.eye(4)
    view[:3, :3] = [s, t, -forward]
    view[:3, 3] = view[:3, :3] @ -np.asarray(centre, dtype=np.float64)
    return view


def face_projection(near: float, far: float) -> Array:
    """A right angle of view both ways.

    Parameters
    ----------
    near, far : float
        Distances of the planes that cut off what is seen; 0 < near < far.

    Returns
    -------
    ndarray, shape (4, 4), float64
        OpenGL clip coordinates from camera coordinates.
    """
    return np.array(
        [
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, -(far + near) / (far - near), -2.0 * far * near / (far - near)],
            [0.0, 0.0, -1.0, 0.0],
        ]
    )


def near_distances(points: Array) -> Array:
    """Near distance of each face, at which the surroundings of an object begin that cannot be hidden.

    Parameters
    ----------
    points : ndarray, shape (n, 3)
        The object's vertices, relative to the middle of their bounding box; world axes.

    Returns
    -------
    ndarray, shape (6,), float64
        Distances that cut the object itself off. On a flat side it is just beyond the object, on others just
        before the outermost point, so that a floor which the object touches is seen.
    """
    near = np.empty(FACE_COUNT)
    for face, (s, t, forward) in enumerate(cube_map.FACES):
        depth = points @ forward
        reach = depth.max()
        outermost = points[depth >= reach * (1.0 - FLATNESS)] @ np.array([s, t]).T
        is_flat = np.ptp(outermost, axis=0).max() > LARGEST_TIP * reach
        near[face] = reach * (1.0 + FLATNESS if is_flat else 1.0 - TIP_SHOWN)
    return near


def faces_within(budget: float, seconds_per_face: Sequence[float]) -> int:
    """Number of faces that a frame may render.

    Parameters
    ----------
    budget : float
        [s] that a frame may spend.
    seconds_per_face : sequence of float
        Times of a face in late updates, with its share of the filtering; > 0.

    Returns
    -------
    int
        1 to 6: one while no times are known, else the budget over their median, because a single update may
        take long for other reasons, such as programs that are compiled.
    """
    if not seconds_per_face:
        return 1
    affordable = int(budget / median(seconds_per_face))
    return min(max(affordable, 1), FACE_COUNT)


def faces_due(due: int, next_face: int, most: int) -> tuple[int, ...]:
    """The faces that a frame renders, in turn: as many as are due and allowed.

    Parameters
    ----------
    due : int
        Number of faces that are older than the scene.
    next_face : int
        The oldest of them.
    most : int
        Number of faces that a frame may render.
    """
    return tuple((next_face + number) % FACE_COUNT for number in range(min(due, most)))
