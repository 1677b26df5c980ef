"""Unit vectors: normalisation, reflection, refraction, and the frame of a camera."""

import numpy as np

from ..conventions import Array, ArrayLike
from ..errors import RangeError


def dot(a: ArrayLike, b: ArrayLike) -> Array:
    """Scalar product over the last axis.

    Parameters
    ----------
    a, b : array_like, shape (..., 3)

    Returns
    -------
    ndarray, shape (...,)
    """
    product: Array = np.einsum("...i,...i->...", np.asarray(a), np.asarray(b))
    return product


def normalize(vectors: ArrayLike) -> Array:
    """Scale vectors to length 1.

    Parameters
    ----------
    vectors : array_like, shape (..., 3)
        Vectors of any positive length.

    Returns
    -------
    ndarray, shape (..., 3), float64
        Unit vectors.

    Raises
    ------
    RangeError
        A vector has length 0 or is not finite, so it has no direction.
    """
    vectors = np.asarray(vectors, dtype=np.float64)
    lengths = np.linalg.norm(vectors, axis=-1, keepdims=True)
    if not np.all(np.isfinite(lengths) & (lengths > 0.0)):
        raise RangeError("A vector of length 0 has no direction: give one that points somewhere.")
    unit: Array = vectors / lengths
    return unit


def reflect(view_dir: ArrayLike, normal: ArrayLike) -> Array:
    """Mirror the view direction about the normal.

    Parameters
    ----------
    view_dir, normal : array_like, shape (..., 3)
        Unit vectors, both pointing away from the surface.

    Returns
    -------
    ndarray, shape (..., 3)
        The unit direction from which a mirror shows light: 2 (n.v) n - v.

    Notes
    -----
    GLSL twin: gpu_shaders/lib/directions_lib.glsl `reflect_dir`, absolute tolerance 1e-6.
    """
    view_dir, normal = np.asarray(view_dir), np.asarray(normal)
    mirrored: Array = 2.0 * dot(normal, view_dir)[..., None] * normal - view_dir
    return mirrored


def mirror_normal(view_dir: ArrayLike, mirror_dir: ArrayLike) -> Array:
    """The normal of a mirror that shows a direction: the inverse of `reflect`, with directions as there.

    Returns
    -------
    ndarray, shape (..., 3)
        Halfway between them; 0 where they are opposite, which `reflect` takes back to the mirror direction,
        too.

    Notes
    -----
    GLSL twin: gpu_shaders/lib/directions_lib.glsl `mirror_normal`, 1e-6 over their sum's length.
    """
    both = np.asarray(view_dir) + np.asarray(mirror_dir)
    length = np.linalg.norm(both, axis=-1, keepdims=True)
    normal: Array = both / np.maximum(length, 1e-9)
    return normal


def refract(view_dir: ArrayLike, normal: ArrayLike, eta: ArrayLike) -> Array:
    """Direction in which an eye sees through a refracting surface.

    Parameters
    ----------
    view_dir, normal : array_like, shape (..., 3)
        Unit vectors, both pointing away from the surface.
    eta : array_like, shape (..., 1) or ()
        Index of refraction behind the surface over that in front of it, greater than 0.

    Returns
    -------
    ndarray, shape (..., 3)
        Unit directions, pointing away from the eye. Beyond the critical angle (eta < 1), where no light
        comes through, the direction along the surface that is seen at that angle.

    Notes
    -----
    Snell's law for the parts of both directions along the surface. GLSL twin:
    gpu_shaders/lib/directions_lib.glsl `refract_dir`, absolute tolerance 1e-6, near the critical angle
    2e-3: the cosine there is the root of a rounding error.
    """
    view_dir, normal = np.asarray(view_dir), np.asarray(normal)
    along = (dot(view_dir, normal)[..., None] * normal - view_dir) / eta
    inwards = np.sqrt(np.maximum(1.0 - dot(along, along), 0.0))[..., None]
    refracted: Array = along - inwards * normal
    return refracted / np.linalg.norm(refracted, axis=-1, keepdims=True)


def transformed_normal(matrix: ArrayLike, normal: ArrayLike) -> Array:
    """The normal of a surface after its points have been transformed.

    Parameters
    ----------
    matrix : array_like, shape (..., 3, 3)
        Matrix that transforms the points; it may mirror and flatten.
    normal : array_like, shape (..., 3)

    Returns
    -------
    ndarray, shape (..., 3)
        Not of length 1.

    Notes
    -----
    The matrix's cofactors are its inverse, transposed, times its determinant; they exist even where a scale
    is 0. GLSL twin: gpu_shaders/lib/directions_lib.glsl `transformed_normal`, 1e-6 of the product of the
    columns' lengths.
    """
    matrix = np.asarray(matrix, dtype=np.float64)
    columns = np.moveaxis(matrix, -1, 0)
    cofactors = np.stack([np.cross(columns[i - 2], columns[i - 1]) for i in range(3)], axis=-1)
    outwards = np.where(np.linalg.det(matrix) < 0.0, -1.0, 1.0)
    transformed: Array = outwards[..., None] * np.einsum("...ij,...j->...i", cofactors, np.asarray(normal))
    return transformed


def turn_about_z(angle: float) -> Array:
    """The rotation about Z by an angle [rad], counter-clockwise seen from above, shape (3, 3)."""
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])


def camera_frame(view_dir: ArrayLike) -> Array:
    """The axes of a camera that looks at the origin, upright.

    Parameters
    ----------
    view_dir : array_like, shape (..., 3)
        Unit vectors from the object to the eye.

    Returns
    -------
    ndarray, shape (..., 3, 3), float64
        Right-handed; columns are the camera's x (right), y (up) and z (towards the camera,
        equal to `view_dir`) in world coordinates: T of [Cabral1999] section 3.3. It maps
        camera coordinates to world coordinates; its transpose maps back.

    Notes
    -----
    The stance of Blender's ``to_track_quat('Z', 'Y')``, in double precision. Straight above and below, where
    "upright" means nothing, x is -X, as there. GLSL twin: gpu_shaders/lib/directions_lib.glsl `camera_frame`,
    1e-6, except for directions within 1e-7 of straight above and below, which count as these.
    """
    z = np.asarray(view_dir, dtype=np.float64)
    x = np.stack([-z[..., 1], z[..., 0], np.zeros_like(z[..., 0])], axis=-1)
    length = np.linalg.norm(x, axis=-1, keepdims=True)
    upright = length > 1e-12
    x = np.where(upright, x / np.where(upright, length, 1.0), (-1.0, 0.0, 0.0))
    return np.stack([x, np.cross(z, x), z], axis=-1)
